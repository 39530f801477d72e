'use strict';
// The page: choices become settings over a case, the engine's answers become pictures and numbers.

const $ = id => document.getElementById(id);
const read = id => JSON.parse($(id).textContent);
const cases = read('cases');
const most_bytes = 4e8, most_of_case = 1e6;

// ---- Engines, each in a worker of its own: the mill goes on while a log is judged. Answers come in the order of the questions.

let compressed = null;

async function engine_bytes() {
  compressed ??= Uint8Array.from(atob($('engine').textContent.trim()), letter => letter.charCodeAt(0));
  const stream = new Blob([compressed]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(stream).arrayBuffer();
}

class Engine {
  waiting = [];
  ready = null;

  /// Loads it, the first time. @throws Error when this browser cannot
  start() {
    this.ready ??= this.load();
    return this.ready;
  }
  async load() {
    if (typeof WebAssembly !== 'object' || typeof DecompressionStream !== 'function')
      throw new Error('This browser has no WebAssembly or cannot decompress: one of 2023 or later is needed.');
    this.worker = new Worker(URL.createObjectURL(new Blob([read('worker')], {type: 'text/javascript'})));
    this.worker.onmessage = ({data}) => {
      if (data.what === 'stage') return this.stage?.(data.stage);
      this.waiting.shift()?.(data);
      if (data.what === 'trap') this.stop();
    };
    const failed = new Promise((_, reject) => {
      this.worker.onerror = event => reject(new Error(`the engine does not start: ${event.message}`));
    });
    await Promise.race([failed, this.question({what: 'engine', engine: await engine_bytes()})]);
  }
  question(message) {
    return new Promise(resolve => {
      this.waiting.push(resolve);
      this.worker.postMessage(message);
    });
  }
  /// The answer, with `problems` where there is none.
  async ask(message) {
    const none = problem => ({answer: {problems: [problem]}, milliseconds: 0});
    const ready = this.start();
    try {
      await ready;
    } catch (error) {
      return none(error.message);
    }
    return this.ready === ready ? this.question(message) : none('stopped');
  }
  /// Ends what it does; the next question begins with a new one.
  stop() {
    this.worker?.terminate();
    this.ready = null;
    for (const resolve of this.waiting.splice(0)) resolve({answer: {problems: ['stopped']}, milliseconds: 0});
  }
}

const mill = new Engine(), judging = new Engine();
judging.stage = stage => { $('verdict').textContent = `Searching: ${stage}.`; };
const ask = message => mill.ask(message);

function problems(list) {
  $('problems').hidden = list.length === 0;
  const lines = list.map(text => text.replace(/^--set /, 'Setting '));
  $('problems').replaceChildren(...lines.map(text => Object.assign(document.createElement('li'), {textContent: text})));
}

// ---- Choices

const fields = {
  count: 'balls.0.count', diameter: 'balls.0.diameter', restitution: 'contact.restitution', friction: 'contact.friction', speed: 'mill.speed',
  most: 'run.max_collisions',
};
const units = {diameter: ' mm', speed: ' rpm'};
const kinds = {
  mill: {
    'as in the case': '', 'SPEX 8000': '{type="spex8000"}', 'vibratory, 11 mm along y': '{type="vibratory",amplitude=["0 mm","11 mm","0 mm"],speed="1500 rpm"}',
    'planetary': '{type="planetary",radius="75 mm",speed="300 rpm",ratio=-2}', 'drum': '{type="drum",speed="120 rpm"}',
  },
  vessel: {
    'as in the case': '', 'cylinder': '{type="cylinder",diameter="38 mm",height="57 mm"}',
    'rounded cylinder': '{type="rounded_cylinder",diameter="38 mm",height="57 mm",edge_radius="8 mm"}', 'capsule': '{type="capsule",diameter="38 mm",height="57 mm"}',
    'sphere': '{type="sphere",diameter="50 mm"}', 'box': '{type="box",size=["34 mm","57 mm","34 mm"]}',
  },
};
let text = '';  // of the case

/// What is not chosen stays as the case has it.
function settings() {
  const list = Object.entries(kinds).filter(([key]) => $(`${key}-kind`).value).map(([key]) => `${key}=${$(`${key}-kind`).value}`);
  for (const [field, key] of Object.entries(fields)) {
    const value = $(field).value.trim();
    if (value === '' || $(field).disabled) continue;
    list.push(units[field] ? `${key}="${value}${units[field]}"` : `${key}=${value}`);
  }
  return list;
}

function choose(name) {
  text = cases[name];
  $('case').value = name;
  for (const field in fields) $(field).value = '';
  for (const key in kinds) $(`${key}-kind`).value = '';
  // Laws by materials go before those of all contacts.
  const by_materials = /^\s*\[\[\s*contact\.pair/m.test(text);
  for (const field of ['restitution', 'friction']) {
    $(field).disabled = by_materials;
    $(field).placeholder = by_materials ? 'by material' : 'case';
  }
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

function line(svg, points, low, high, unit, none = '') {
  const [left, right, top, bottom] = [45, 392, 10, 175];
  if (points.length === 0) {
    svg.innerHTML = `<path class="axis" d="M${left} ${top}V${bottom}H${right}"/><text x="${(left + right) / 2}" y="${(top + bottom) / 2}" text-anchor="middle">${none}</text>`;
    return;
  }
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
  line($('rate'), rates, 0, high, 's', frame.time < scene.start ? `statistics begin at ${number(scene.start)} s` : '');
  bars($('spectrum'), frame.speeds);
}

// ---- Running

let going = false, run_number = 0, ended = false, chunk = 0.03;

function enable() {
  const runs = scene !== null && !ended;
  for (const id of ['pause', 'step', 'end']) $(id).disabled = !runs;
  $('stop').disabled = !runs && $('said').textContent !== placing;
  $('save').disabled = scene === null;
  $('pause').textContent = going || !runs ? 'Pause' : 'Go on';
}

const placing = 'Placing the balls.';

function say(what) {
  $('said').textContent = what;
  enable();
}

/// Ends what goes on, without a result.
function give_up(what, list = []) {
  ++run_number;
  going = false;
  scene = frame = null;
  draw();
  say(what);
  problems(list);
}

async function begin() {
  if ($('said').textContent === placing) mill.stop();
  give_up(placing);
  const own = run_number;
  const {answer} = await ask({what: 'begin', text, settings: settings(), log: $('keep').checked});
  if (own !== run_number) return;
  if (answer.problems) return give_up('The case has problems.', answer.problems);
  scene = answer;
  scene.size = 0;
  scene.meshes = Object.values(scene.walls).map(({points, faces}) => {
    const list = [];
    for (let k = 0; k < faces.length; k += faces[k] + 1) list.push(faces.slice(k + 1, k + 1 + faces[k]));
    return {points: Array.from({length: points.length / 3}, (_, k) => points.slice(3 * k, 3 * k + 3)), faces: list};
  });
  rates = [], last_dose = [0, 0], ended = false, chunk = 0.03;
  const first = (await ask({what: 'advance', time: 0})).answer;
  if (own !== run_number) return;
  if (first.problems) return give_up('The run has stopped.', first.problems);
  take(first);
  $('version').textContent = scene.version;
  going = true;
  say('Running.');
  play(own);
}

/// The next state at a time, or after one impact; whether the run has gone on.
async function advance(time, own) {
  const {answer, milliseconds} = await ask({what: 'advance', time});
  if (own !== run_number) return false;
  if (answer.problems) {
    give_up('The run has stopped.', answer.problems);
    return false;
  }
  const before = frame.impacts;
  take(answer);
  if (time < 0 && answer.impacts === before && !answer.ended) say('No impact in the next hundred drive periods.');
  chunk *= milliseconds > 100 ? 0.5 : milliseconds < 40 ? 2 : 1;
  if (answer.ended) await finish(own);
  return !answer.ended;
}

const next_picture = () => new Promise(requestAnimationFrame);

async function play(own) {
  let before = await next_picture();
  while (going && own === run_number) {
    const now = await next_picture(), pace = Number($('pace').value);
    if (!going || own !== run_number) return;
    const step = pace > 0 ? Math.min(pace * (now - before) / 1000, 0.05) : chunk;
    before = now;
    if (!await advance(frame.time + step, own)) return;
  }
}

async function finish(own) {
  going = false;
  const {answer} = await ask({what: 'finish'});
  if (own !== run_number) return;
  if (answer.problems) return give_up('The run has stopped.', answer.problems);
  ended = true;
  show_facts({'ended by': frame.end_reason, ...(answer.digest ? {'SHA-256 of collisions.csv': answer.digest} : {})});
  say('The run has ended.');
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

async function case_of(file) {
  if (!file) throw new Error('choose the case');
  if (file.size > most_of_case) throw new Error(`${file.name} has ${number(file.size / 1e6, 2)} MB: a case file (TOML) is shorter`);
  return file.text();
}

async function judge(what) {
  const busy = yes => {
    for (const id of ['audit', 'compare']) $(id).disabled = yes;
    $('judge-stop').disabled = !yes;
  };
  $('table').hidden = true;
  $('verdict').textContent = 'Reading.';
  busy(true);
  try {
    const log = await bytes_of('log', 'a collision log');
    const message = what === 'audit'
      ? {what, log, text: await case_of($('judged-case').files[0]), settings: $('settings').value.split('\n'), identify: $('identify').checked}
      : {what, log, reference: await bytes_of('reference', 'a reference log')};
    const {answer} = await judging.ask(message);
    const bad = answer.problems;
    $('verdict').textContent = bad ? 'No verdict:' : `Verdict: ${answer.verdict.replace('_', ' ')}`;
    $('table').textContent = bad ? bad.join('\n') : answer.table;
    $('table').hidden = false;
  } catch (error) {
    $('verdict').textContent = `No verdict: ${error.message}.`;
  }
  busy(false);
}

/// A file that was dropped on the page goes where one of its kind is expected.
function give(input, file) {
  const list = new DataTransfer();
  list.items.add(file);
  $(input).files = list.files;
  $(input).dispatchEvent(new Event('change'));
}

// ---- Events

$('case').append(...Object.keys(cases).map(name => new Option(name, name)));
for (const [key, list] of Object.entries(kinds)) $(`${key}-kind`).append(...Object.entries(list).map(([name, value]) => new Option(name, value)));
$('case').addEventListener('change', () => choose($('case').value));
$('choices').addEventListener('submit', event => {
  event.preventDefault();
  begin();
});
$('pause').addEventListener('click', () => {
  going = !going;
  say(going ? 'Running.' : 'Paused.');
  if (going) play(run_number);
});
$('step').addEventListener('click', () => {
  going = false;
  say('Paused.');
  advance(-1, run_number);
});
$('end').addEventListener('click', () => {
  $('pace').value = '0';
  if (!going) $('pause').click();
});
$('stop').addEventListener('click', () => {
  mill.stop();
  give_up('Stopped.');
});
$('save').addEventListener('click', async () => {
  const {answer} = await ask({what: 'case'});
  if (answer.problems) problems(answer.problems);
  else save('case.toml', answer.case);
});
$('open').addEventListener('change', async () => {
  const file = $('open').files[0];
  if (!file) return;
  $('open').value = '';  // so that it can be opened again, when it has changed
  try {
    const content = await case_of(file);
    if (!(file.name in cases)) $('case').append(new Option(file.name, file.name));
    cases[file.name] = content;
    choose(file.name);
    begin();
  } catch (error) {
    problems([`${error.message}.`]);
  }
});
for (const what of ['dragover', 'drop'])
  document.addEventListener(what, event => {
    if (!event.dataTransfer?.types.includes('Files')) return;
    event.preventDefault();
    if (what === 'dragover') return;
    const see = event.target.closest?.('#see');
    for (const file of event.dataTransfer.files)
      give(!file.name.endsWith('.toml') ? 'log' : see ? 'open' : 'judged-case', file);
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
$('judge-stop').addEventListener('click', () => judging.stop());

choose(Object.keys(cases)[0]);
mill.start().then(
  () => { say('Choose and press Run.'); $('run').disabled = false; },
  error => { say(''); problems([error.message]); });
