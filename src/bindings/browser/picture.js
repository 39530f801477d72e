// The mill in motion, numbers and charts.

const view = new MillView($('mill'), [0, 0, 0], 1, 0.6, 0.35);
let scene = null, frame = null;

function draw() {
  if (!scene || !frame) return view.draw([], [], {});
  const in_frame = ([origin, ...axes]) => p => [0, 1, 2].map(k => origin[k] + axes.reduce((sum, axis, c) => sum + axis[k] * p[c], 0));
  const walls = scene.meshes.map(wall => ({points: wall.points.map(in_frame(frame.vessel)), flat: wall.faces.length === 1}));
  const solids = Object.values(scene.bodies).map(({points, colour}, k) =>
    ({points: points.map(in_frame(frame.bodies[k])), colour: `rgb(${colour.map(part => Math.round(255 * part))})`}));
  // The picture includes all of the space that the vessel has swept so far.
  const reach = Math.max(...walls.flatMap(({points}) => points.map(p => Math.hypot(...p.map((c, k) => c - scene.middle[k])))));
  if (reach > scene.size) {
    view.distance = scene.size > 0 ? view.distance * reach / scene.size : 3.6 * reach;
    scene.size = reach;
  }
  const colours = getComputedStyle(document.documentElement), line = colours.getPropertyValue('--soft').trim();
  const last = frame.last && [frame.last.ball, frame.last.with_wall ? -1 : frame.last.partner];
  const colour = k => last && last.includes(k) ? '#c2410c' : colours.getPropertyValue('--ball').trim();
  view.draw(walls, scene.radii.map((radius, k) => ({radius, place: frame.places[k], colour: colour(k)})), {colour: line, opacity: 0.12, edge: line}, [], solids);
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
  if (frame.results) {
    Object.assign(facts, frame.results);
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
  $('facts').replaceChildren(...Object.entries(facts).flatMap(([name, value]) => [element('dt', name), element('dd', value)]));
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
