'use strict';
// The page: choices become settings over a case, the engine's answers become pictures and numbers.

const $ = id => document.getElementById(id);
const read = id => JSON.parse($(id).textContent);
const cases = read('cases');
const most_balls = 5000, most_bytes = 4e8;

// ---- The engine, in a worker. Its answers come in the order of the questions.

let worker = null, waiting = [];

async function engine_bytes() {
  const compressed = Uint8Array.from(atob($('engine').textContent.trim()), letter => letter.charCodeAt(0));
  const stream = new Blob([compressed]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(stream).arrayBuffer();
}

function ask(message, transfer = []) {
  return new Promise(resolve => {
    waiting.push(resolve);
    worker.postMessage(message, transfer);
  });
}

async function start_engine() {
  if (typeof WebAssembly !== 'object' || typeof DecompressionStream !== 'function')
    throw new Error('This browser has no WebAssembly or cannot decompress: one of 2023 or later is needed.');
  if (worker) worker.terminate();
  waiting = [];
  worker = new Worker(URL.createObjectURL(new Blob([read('worker')], {type: 'text/javascript'})));
  worker.onmessage = ({data}) => {
    if (data.what === 'stage') $('verdict').textContent = `Searching: ${data.stage}.`;
    else waiting.shift()(data);
  };
  worker.onerror = event => problems([`the engine does not start: ${event.message}`]);
  await ask({what: 'engine', engine: await engine_bytes()});
}

function problems(list) {
  $('problems').hidden = list.length === 0;
  $('problems').replaceChildren(...list.map(text => Object.assign(document.createElement('li'), {textContent: text})));
}

// ---- Choices

const fields = {
  count: 'balls.0.count', diameter: 'balls.0.diameter', restitution: 'contact.restitution', friction: 'contact.friction', speed: 'mill.speed',
  most: 'run.max_collisions',
};
const units = {diameter: ' mm', speed: ' rpm'};
let text = '';  // of the case

/// Empty fields leave what the case says.
function settings() {
  const list = [];
  for (const [field, key] of Object.entries(fields)) {
    const value = $(field).value.trim();
    if (value === '') continue;
    list.push(units[field] ? `${key}="${value}${units[field]}"` : `${key}=${value}`);
  }
  return list;
}

function choose(name) {
  text = cases[name];
  for (const field in fields) $(field).value = '';
}

// ---- The picture

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
  const [origin, x, y, z] = [0, 3, 6, 9].map(k => frame.vessel.slice(k, k + 3));
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
  const balls = scene.radii.map((radius, k) => [...seen(frame.places.slice(3 * k, 3 * k + 3)), radius * scale, k]);
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

function line(svg, points, low, high, unit) {
  const [left, right, top, bottom] = [45, 392, 10, 175];
  const first = points.length ? points[0][0] : 0, last = points.length ? points[points.length - 1][0] : 1;
  const place = ([t, value]) => [left + (right - left) * (t - first) / Math.max(last - first, 1e-12), bottom - (bottom - top) * (value - low) / (high - low)];
  svg.innerHTML = `<path class="axis" d="M${left} ${top}V${bottom}H${right}"/><text x="${left - 4}" y="${top + 8}" text-anchor="end">${number(high, 3)}</text>
    <text x="${left - 4}" y="${bottom}" text-anchor="end">${number(low, 3)}</text><text x="${left}" y="192">${number(first, 3)} ${unit}</text>
    <text x="${right}" y="192" text-anchor="end">${number(last, 4)} ${unit}</text>
    <path class="curve" d="${points.map((p, k) => (k ? 'L' : 'M') + place(p).map(c => c.toFixed(1)).join(' ')).join('')}"/>`;
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
  line($('rate'), rates, 0, high, 's');
  bars($('spectrum'), frame.speeds);
}

// ---- Running

let going = false, run_number = 0, result = null, chunk = 0.03;

function enable(running) {
  for (const id of ['pause', 'step', 'end']) $(id).disabled = !running;
  $('save').disabled = scene === null;
  $('pause').textContent = going ? 'Pause' : 'Go on';
}

async function begin() {
  const own = ++run_number;
  going = false;
  problems([]);
  const said = settings();
  $('said').textContent = 'Placing the balls.';
  const {answer} = await ask({what: 'begin', text, settings: said, log: $('keep').checked});
  if (own !== run_number) return;
  if (answer.problems) {
    scene = null;
    $('said').textContent = 'The case has problems.';
    return problems(answer.problems);
  }
  if (answer.balls > most_balls) {
    scene = null;
    $('said').textContent = '';
    return problems([`${answer.balls} balls are too many to be drawn: this page takes up to ${most_balls}; the command line takes any number.`]);
  }
  scene = answer;
  scene.size = 0;
  scene.meshes = Object.values(scene.walls).map(({points, faces}) => {
    const list = [];
    for (let k = 0; k < faces.length; k += faces[k] + 1) list.push(faces.slice(k + 1, k + 1 + faces[k]));
    return {points: Array.from({length: points.length / 3}, (_, k) => points.slice(3 * k, 3 * k + 3)), faces: list};
  });
  rates = [], last_dose = [0, 0], result = null, chunk = 0.03;
  take((await ask({what: 'advance', time: 0})).answer);
  $('version').textContent = scene.version;
  going = true;
  enable(true);
  $('said').textContent = 'Running.';
  play(own);
}

/// The next state at a time, or after one impact; whether the run has gone on.
async function advance(time, own) {
  const {answer, milliseconds} = await ask({what: 'advance', time});
  if (own !== run_number) return false;
  if (answer.problems) {
    going = false;
    problems(answer.problems);
    return false;
  }
  take(answer);
  chunk *= milliseconds > 100 ? 0.5 : milliseconds < 40 ? 2 : 1;
  if (answer.ended) await finish(own);
  return !answer.ended;
}

const next_picture = () => new Promise(requestAnimationFrame);

async function play(own) {
  let before = await next_picture();
  while (going && own === run_number) {
    const now = await next_picture(), pace = Number($('pace').value);
    const step = pace > 0 ? Math.min(pace * (now - before) / 1000, 0.05) : chunk;
    before = now;
    if (!await advance(frame.time + step, own)) return;
  }
}

async function finish(own) {
  going = false;
  const {answer} = await ask({what: 'finish'});
  if (own !== run_number) return;
  if (answer.problems) return problems(answer.problems);
  result = answer;
  show_facts({'ended by': frame.end_reason, ...(answer.digest ? {'SHA-256 of collisions.csv': answer.digest} : {})});
  $('said').textContent = 'The run has ended.';
  enable(false);
}

function save(name, content) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob([content], {type: 'text/plain'}));
  link.download = name;
  link.click();
  URL.revokeObjectURL(link.href);
}

// ---- Verifying

async function bytes_of(id, what) {
  const file = $(id).files[0];
  if (!file) throw new Error(`choose ${what}`);
  if (file.size > most_bytes)
    throw new Error(`${file.name} has ${Math.round(file.size / 1e6)} MB: this page takes up to ${most_bytes / 1e6} MB; the command line reads logs of any length`);
  return new Uint8Array(await file.arrayBuffer());
}

async function judge(what) {
  $('table').hidden = true;
  $('verdict').textContent = 'Reading.';
  try {
    const log = await bytes_of('log', 'a collision log');
    const message = what === 'audit'
      ? {what, log, text: new TextDecoder().decode(await bytes_of('judged-case', 'the case')), settings: $('settings').value.split('\n'),
         identify: $('identify').checked}
      : {what, log, reference: await bytes_of('reference', 'a reference log')};
    const {answer} = await ask(message);
    const bad = answer.problems;
    $('verdict').textContent = bad ? 'No verdict:' : `Verdict: ${answer.verdict.replace('_', ' ')}`;
    $('table').textContent = bad ? bad.join('\n') : answer.table;
    $('table').hidden = false;
  } catch (error) {
    $('verdict').textContent = `No verdict: ${error.message}.`;
  }
}

// ---- Events

$('case').append(...Object.keys(cases).map(name => new Option(name, name)));
$('case').addEventListener('change', () => choose($('case').value));
$('choices').addEventListener('submit', event => {
  event.preventDefault();
  begin();
});
$('pause').addEventListener('click', () => {
  going = !going;
  enable(true);
  if (going) play(run_number);
});
$('step').addEventListener('click', () => {
  going = false;
  enable(true);
  advance(-1, run_number);
});
$('end').addEventListener('click', () => {
  $('pace').value = '0';
  if (!going) $('pause').click();
});
$('save').addEventListener('click', async () => {
  if (!result) {
    going = false;
    await finish(run_number);
  }
  if (result) save('case.toml', result.case);
});
$('open').addEventListener('change', async () => {
  const file = $('open').files[0];
  if (!file) return;
  choose($('case').value);
  text = await file.text();
  begin();
});
$('mill').addEventListener('keydown', event => {
  const turns = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1]}[event.key];
  if (!turns) return;
  event.preventDefault();
  turn(...turns);
});
$('mill').addEventListener('pointermove', event => {
  if (event.buttons & 1) turn(event.movementX / 100, event.movementY / 100);
});
$('judge').addEventListener('submit', event => {
  event.preventDefault();
  judge('audit');
});
$('compare').addEventListener('click', () => judge('compare'));

choose(Object.keys(cases)[0]);
start_engine().then(
  () => { $('said').textContent = 'Choose and press Run.'; $('run').disabled = false; },
  error => { $('said').textContent = ''; problems([error.message]); });
