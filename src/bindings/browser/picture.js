// The mill in motion, numbers and charts.

const view = {azimuth: 0.6, elevation: 0.35};
let scene = null, frame = null;

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

function camera() {
  const [ca, sa, ce, se] = [Math.cos(view.azimuth), Math.sin(view.azimuth), Math.cos(view.elevation), Math.sin(view.elevation)];
  return {right: [ca, 0, -sa], up: [-sa * se, ce, -ca * se], towards: [sa * ce, se, ca * ce]};
}

function draw() {
  const canvas = $('mill'), context = canvas.getContext('2d');
  context.clearRect(0, 0, canvas.width, canvas.height);
  if (!scene || !frame) return;
  const colours = getComputedStyle(document.documentElement);
  const {right, up, towards} = camera();
  const [origin, x, y, z] = frame.vessel;
  const outside = p => [0, 1, 2].map(k => origin[k] + x[k] * p[0] + y[k] * p[1] + z[k] * p[2]);
  // What the vessel has swept so far is in the picture.
  for (const wall of scene.meshes)
    for (const point of wall.points) scene.size = Math.max(scene.size, Math.hypot(...outside(point).map((c, k) => c - scene.middle[k])));
  const scale = 0.47 * Math.min(canvas.width, canvas.height) / scene.size;
  const seen = p => {
    const d = [p[0] - scene.middle[0], p[1] - scene.middle[1], p[2] - scene.middle[2]];
    return [canvas.width / 2 + scale * dot(d, right), canvas.height / 2 - scale * dot(d, up), dot(d, towards)];
  };
  context.strokeStyle = colours.getPropertyValue('--line');
  for (const wall of scene.meshes)
    for (const face of wall.faces) {
      context.beginPath();
      face.forEach((corner, k) => {
        const [u, v] = seen(outside(wall.points[corner]));
        if (k) context.lineTo(u, v); else context.moveTo(u, v);
      });
      context.closePath();
      context.stroke();
    }
  const balls = scene.radii.map((radius, k) => [...seen(frame.places[k]), radius * scale, k]);
  balls.sort((a, b) => a[2] - b[2]);
  const colour = colours.getPropertyValue('--ball').trim(), edge = colours.getPropertyValue('--card').trim();
  const last = frame.last && [frame.last.ball, frame.last.with_wall ? -1 : frame.last.partner];
  for (const [u, v, , radius, k] of balls) {
    context.beginPath();
    context.arc(u, v, Math.max(radius, 1), 0, 2 * Math.PI);
    context.fillStyle = last && last.includes(k) ? '#c2410c' : colour;
    context.fill();
    context.strokeStyle = edge;
    context.stroke();
  }
}

function turn(azimuth, elevation) {
  view.azimuth += azimuth;
  view.elevation = Math.max(-1.5, Math.min(1.5, view.elevation + elevation));
  draw();
}

// ---- Numbers and charts

const number = (value, digits = 4) => String(Number(Number(value).toPrecision(digits)));
let rates = [];
const path = (points, cls) => `<path class="${cls}" d="${points.map((p, k) => (k ? 'L' : 'M') + p.map(c => c.toFixed(1)).join(' ')).join('')}"/>`;

function line(svg, points, low, high, unit, none = '') {
  const [left, right, top, bottom] = [45, 392, 10, 175];
  if (points.length === 0) {
    svg.innerHTML = `<path class="axis" d="M${left} ${top}V${bottom}H${right}"/><text x="${(left + right) / 2}" y="${(top + bottom) / 2}" text-anchor="middle">${none}</text>`;
    return;
  }
  const first = points[0][0], last = points[points.length - 1][0];
  const place = ([t, value]) => [left + (right - left) * (t - first) / Math.max(last - first, 1e-12), bottom - (bottom - top) * (value - low) / (high - low)];
  svg.innerHTML = `<path class="axis" d="M${left} ${top}V${bottom}H${right}"/><text x="${left - 4}" y="${top + 8}" text-anchor="end">${number(high, 3)}</text>
    <text x="${left - 4}" y="${bottom}" text-anchor="end">${number(low, 3)}</text><text x="${left}" y="192">${number(first, 3)} ${unit}</text>
    <text x="${right}" y="192" text-anchor="end">${number(last, 4)} ${unit}</text>
    ${path(points.map(place), 'curve')}`;
}

function bars(svg, counts) {
  const [left, right, top, bottom] = [45, 392, 10, 175], high = Math.max(1, ...counts), width = (right - left) / counts.length;
  const labels = [0.001, 0.01, 0.1, 1, 10].map((speed, k) =>
    `<text x="${left + (right - left) * k / 4}" y="192" text-anchor="middle">${speed}</text>`).join('');
  svg.innerHTML = `<path class="axis" d="M${left} ${top}V${bottom}H${right}"/><text x="${left - 4}" y="${top + 8}" text-anchor="end">${high}</text>${labels}` +
    counts.map((count, k) => {
      const height = (bottom - top) * count / high;
      return `<rect class="bar" x="${left + k * width}" y="${bottom - height}" width="${width - 1}" height="${height}"/>`;
    }).join('');
}

function show_facts(more = {}) {
  const facts = {'time': `${number(frame.time, 6)} s`, 'impacts': frame.impacts};
  if ('dose_rate' in frame) {
    const width = 'half_width' in frame ? ` ± ${number(frame.half_width, 2)}` : '';
    facts['milling dose rate'] = `${number(frame.dose_rate)}${width} W`;
    const all = frame.collisions.reduce((a, b) => a + b, 0);
    facts['collisions'] = `${number(all / (frame.time - scene.start))} per second`;
    scene.partners.forEach((name, k) => { facts[name] = `${frame.collisions[k]}, ${number(frame.dose_by_partner[k], 3)} J`; });
  } else {
    facts['statistics'] = `from ${scene.start} s on`;
  }
  if (frame.last) {
    const partner = frame.last.with_wall ? scene.partners[frame.last.partner] : `ball ${frame.last.partner}`;
    facts['last impact'] = `ball ${frame.last.ball} and ${partner}: ${number(frame.last.approach_speed, 3)} m/s towards each other, ` +
      `${number(frame.last.separation_speed, 3)} m/s apart, ${number(1000 * frame.last.milling_dose, 3)} mJ`;
  }
  Object.assign(facts, more);
  $('facts').replaceChildren(...Object.entries(facts).flatMap(([name, value]) =>
    [Object.assign(document.createElement('dt'), {textContent: name}), Object.assign(document.createElement('dd'), {textContent: value})]));
}

let last_dose = [0, 0];

function take(answer) {
  frame = answer;
  if ('dose' in frame) {
    const [time, dose] = last_dose, step = scene.period * 5;
    if (time === 0) last_dose = [frame.time, frame.dose];
    else if (frame.time - time >= step) {
      rates.push([frame.time, (frame.dose - dose) / (frame.time - time)]);
      last_dose = [frame.time, frame.dose];
    }
  }
  draw();
  show_facts();
  const high = Math.max(1e-9, ...rates.map(r => r[1])) * 1.1;
  line($('rate'), rates, 0, high, 's', frame.time < scene.start ? `statistics begin at ${number(scene.start)} s` : '');
  bars($('spectrum'), frame.speeds);
}
