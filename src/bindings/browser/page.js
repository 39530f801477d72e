// The page: choices become settings over a case, the engine's answers become pictures and numbers.

const cases = read('cases');
const most_bytes = 4e8, most_of_case = 1e6;

const element = (kind, text) => Object.assign(document.createElement(kind), {textContent: text});

function problems(list) {
  $('problems').hidden = list.length === 0;
  const lines = list.map(text => text.replace(/^--set /, 'Setting '));
  $('problems').replaceChildren(...lines.map(text => element('li', text)));
}

// ---- Choices

const fields = {
  count: 'balls.0.count', diameter: 'balls.0.diameter', restitution: 'contact.restitution', friction: 'contact.friction', speed: 'mill.speed',
  most: 'run.max_collisions',
};
const units = {diameter: ' mm', speed: ' rpm'};  // of a number without one
const of_machine = ['jar', 'charge', 'fill', 'powder', 'target'];
let text = '';  // of the case

/// As it is written in the field, with its unit.
function written(field) {
  const value = $(field).value.trim();
  return value === '' || !units[field] || /[a-df-z]/i.test(value) ? value : value + units[field];
}

/// The settings that the reader has chosen; all other keys keep the values of the case.
function settings() {
  const list = $('vessel-kind').value ? [`vessel=${$('vessel-kind').value}`] : [];
  for (const [field, key] of Object.entries(fields)) {
    const value = written(field);
    if (value === '' || $(field).disabled || (field === 'speed' && !($('case').value in cases))) continue;
    list.push(units[field] ? `${key}="${value}"` : `${key}=${value}`);
  }
  return list;
}

function choose(name) {
  $('case').value = name;
  text = cases[name] ?? '';
  for (const field of [...Object.keys(fields), 'vessel-kind']) $(field).value = '';
  for (const field of of_machine) [$(field).value, $(field).disabled] = ['', name in cases];
  // Laws by materials go before those of all contacts.
  const by_materials = /^\s*\[\[\s*contact\.pair/m.test(text);
  for (const field of ['restitution', 'friction']) $(field).disabled = by_materials;
  show_values(by_materials ? {'contact.restitution': 'by material', 'contact.friction': 'by material'} : {});
}

/// Shows the values of the run in fields without a choice.
function show_values(values) {
  for (const [field, key] of Object.entries(fields))
    if (!$(field).disabled || key in values) $(field).placeholder = values[key] ?? '';
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

/// Ends the current task without a result.
function give_up(what, list = []) {
  ++run_number;
  going = false;
  scene = frame = null;
  draw();
  say(what);
  problems(list);
}

/// Asks the engine for a task; no answer where another has begun, or after problems, which are
/// shown.
async function ask_for(own, message, sorry = 'The run has stopped.') {
  const got = await ask(message);
  if (own === run_number && got.answer.problems) give_up(sorry, got.answer.problems);
  return own === run_number ? got : {};
}

async function begin() {
  if ($('said').textContent === placing) mill.stop();
  give_up(placing);
  $('facts').replaceChildren();
  const own = run_number;
  const name = $('case').value;
  if (!(name in cases)) {
    const wanted = [name, ...of_machine.map(written), written('speed')];
    const made = (await ask({what: 'new', wanted})).answer;
    if (own !== run_number) return;
    if (name !== $('case').value) return give_up('Another mill was chosen.');
    if (made.problems) return give_up('The mill has problems.', made.problems);
    text = made.case;
  }
  const {answer} = await ask_for(own, {what: 'begin', text, settings: settings(), log: $('keep').checked}, 'The case has problems.');
  if (!answer) return;
  scene = {...answer, size: 0, meshes: Object.values(answer.walls)};
  show_values(scene.values);
  view.target = scene.middle;
  rates = [], last_dose = [0, 0], ended = false, chunk = 0.03;
  const {answer: first} = await ask_for(own, {what: 'advance', time: 0});
  if (!first) return;
  take(first);
  $('version').textContent = scene.version;
  going = true;
  say('Running.');
  play(own);
}

/// The next state at a time, or after one impact; whether the run has gone on. A chunk that it was
/// sets the size of the next one.
async function advance(time, own, of_chunk = false) {
  const {answer, milliseconds} = await ask_for(own, {what: 'advance', time});
  if (!answer) return false;
  const before = frame.impacts;
  take(answer);
  if (time < 0 && answer.impacts === before && !answer.ended) say('No impact in the next hundred drive periods.');
  // At most so long that the chart of a run of seconds has enough points on any machine.
  if (of_chunk) chunk = Math.min(0.2, chunk * (milliseconds > 100 ? 0.5 : milliseconds < 40 ? 2 : 1));
  if (answer.ended) await finish(own);
  return !answer.ended;
}

const next_picture = () => new Promise(requestAnimationFrame);

async function play(own) {
  let before = await next_picture();
  while (going && own === run_number) {
    const now = await next_picture(), pace = Number($('pace').value);
    if (!going || own !== run_number) return;
    const paced = pace > 0, step = paced ? Math.min(pace * (now - before) / 1000, 0.05) : chunk;
    before = now;
    if (!await advance(frame.time + step, own, !paced)) return;
  }
}

async function finish(own) {
  going = false;
  const {answer} = await ask_for(own, {what: 'finish'});
  if (!answer) return;
  ended = true;
  show_facts({'ended by': frame.end_reason, ...(answer.digest ? {'SHA-256 of collisions.csv': answer.digest} : {})});
  say('The run has ended.');
}

function save(name, content) {
  const href = URL.createObjectURL(new Blob([content], {type: 'text/plain'}));
  const link = Object.assign(document.createElement('a'), {href, download: name});
  link.click();
  URL.revokeObjectURL(href);
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

function on_submit(form, action) {
  $(form).addEventListener('submit', event => {
    event.preventDefault();
    action();
  });
}

$('examples').append(...Object.keys(cases).map(name => new Option(name, name)));
$('case').addEventListener('change', () => choose($('case').value));
on_submit('choices', begin);
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
    if (!(file.name in cases)) $('examples').append(new Option(file.name, file.name));
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
view.listen(draw);
on_submit('judge', () => judge('audit'));
$('compare').addEventListener('click', () => judge('compare'));
$('judge-stop').addEventListener('click', () => judging.stop());

choose(Object.keys(cases)[0]);
mill.start().then(async () => {
  const {answer} = await ask({what: 'machines'});
  $('run').disabled = false;
  $('machines').append(...Object.entries(answer).map(([key, name]) => new Option(name, key)));
  if (matchMedia('(prefers-reduced-motion: reduce)').matches) say('Choose and press Run.');
  else begin();
}, error => { say(''); problems([error.message]); });
