
// ---- Five steps that teach what event-driven means

const value_of = id => Number($(id).value);

function show_flight() {
  const place = t => [20 + 3.6 * t, 30 + 0.012 * (t - 25) ** 2 * 1.6];
  const all = Array.from({length: 101}, (_, t) => place(t)), [x, y] = place(value_of('flight-time'));
  $('flight').innerHTML = path(all, 'axis') + path(all.slice(0, value_of('flight-time') + 1), 'curve') + `<circle class="bar" cx="${x}" cy="${y}" r="8"/>` +
    path([[12, 10], [12, 160], [390, 160]], 'axis') + '<text x="18" y="18">height</text><text x="388" y="154" text-anchor="end">distance</text>';
}

// A ball that falls on a table: gap(t), its rate, and a bound on its bend, which is gravity and the
// table's acceleration.
const table = {size: 0.12, pulse: 2 * Math.PI * 1.4, height: 0.55, fall: 9.81 / 9};
const gap = t => table.height - table.fall * t * t / 2 - table.size * Math.sin(table.pulse * t);
const rate = t => -table.fall * t - table.size * table.pulse * Math.cos(table.pulse * t);
const bend = table.fall + table.size * table.pulse ** 2;
let search;

/// The longest time without a contact: gap + rate s - bend s^2/2 > 0.
const excluded = t => (rate(t) + Math.sqrt(rate(t) ** 2 + 2 * bend * gap(t))) / bend;

function begin_search() {
  search = {at: 0, done: [], bracket: null, steps: 0};
  show_gap();
}

function search_step() {
  ++search.steps;
  if (search.bracket) {
    const [low, high] = search.bracket, middle = (low + high) / 2;
    search.bracket = gap(middle) > 0 ? [middle, high] : [low, middle];
  } else {
    const far = excluded(search.at);
    search.done.push([search.at, search.at + far]);
    search.at += far;
    // Where the rate cannot change its sign there is one contact at most.
    for (let reach = 0.1; reach > 1e-9 && !search.bracket; reach /= 2)
      if (rate(search.at) + bend * reach < 0 && gap(search.at + reach) < 0) search.bracket = [search.at, search.at + reach];
  }
  show_gap();
}

function show_gap() {
  const place = (t, g) => [30 + 340 * t, 140 - 180 * g];
  const curve = Array.from({length: 201}, (_, k) => place(k / 200, gap(k / 200)));
  const strip = ([from, to], cls) => `<rect class="${cls}" x="${place(from, 0)[0]}" y="20" width="${Math.max(340 * (to - from), 1.5)}" height="150" fill-opacity="0.25"/>`;
  $('gap').innerHTML = search.done.map(s => strip(s, 'skipped')).join('') + (search.bracket ? strip(search.bracket, 'bracket') : '') +
    path([place(0, 0), place(1, 0)], 'axis') + path(curve, 'curve') + '<text x="30" y="186">time [s], from 0 to 1</text><text x="30" y="14">gap</text>';
  const width = search.bracket ? search.bracket[1] - search.bracket[0] : 0;
  $('gap-said').textContent = search.bracket
    ? `Step ${search.steps}: the contact is between ${search.bracket[0].toFixed(9)} and ${search.bracket[1].toFixed(9)} s, a bracket of ${width.toExponential(1)} s.`
    : search.steps ? `Step ${search.steps}: no contact before ${search.at.toFixed(6)} s.` : '';
}

/// Equations (2.23'), (2.24') of a solid ball against a wall: c = 1 + 5/2.
function show_law() {
  const [e, mu, normal, slip] = [value_of('law-e') / 100, value_of('law-mu') / 100, value_of('law-n') / 100, value_of('law-t') / 100];
  const et = slip > 0 ? Math.max(-1, 1 - mu * 3.5 * normal * (1 + e) / slip) : 0;
  const arrow = (x, y, u, v, cls) => path([[x, y], [x + u, y + v]], cls) + `<circle class="bar" cx="${x + u}" cy="${y + v}" r="3"/>`;
  $('impact').innerHTML = path([[20, 140], [380, 140]], 'axis') + '<text x="380" y="156" text-anchor="end">slip, along the wall</text>' +
    '<text x="20" y="20">approach, across it</text>' + '<circle class="axis" cx="200" cy="100" r="40"/>' +
    arrow(200 - 40 * slip, 140 - 40 * normal, 40 * slip, 40 * normal, 'axis') + arrow(200, 140, 40 * et * slip, -40 * e * normal, 'curve');
  $('law-said').textContent = `Before: ${number(normal, 3)} m/s towards each other, ${number(slip, 3)} m/s of slip. After: ${number(e * normal, 3)} m/s apart, slip times e_t = ${number(et, 3)}` +
    ` (${et > -1 ? 'it slides to the end' : 'it sticks and springs back'}).`;
}

async function diverge() {
  const most = 2000;
  $('divergence-said').textContent = 'Running.';
  const run = settings => judging.ask({what: 'first_impacts', text: cases[Object.keys(cases)[0]], settings, most});
  const one = (await run([])).answer, other = (await run(['contact.restitution=0.5300000000001'])).answer;
  const failed = one.problems ?? other.problems;
  if (failed) return void ($('divergence-said').textContent = failed.join(' '));
  const same = k => one.ball[k] === other.ball[k] && one.partner[k] === other.partner[k];
  let common = 0;
  while (common < most && same(common)) ++common;
  const points = [];
  for (let k = 0; k < common; ++k) {
    const off = Math.abs(one.time[k] - other.time[k]);
    if (off > 0) points.push([k + 1, Math.log10(off)]);
  }
  line($('divergence'), points, -18, 0, '');
  $('divergence').innerHTML += '<text x="52" y="18">log10 of the difference [s]</text><text x="388" y="168" text-anchor="end">number of the impact</text>';
  $('divergence-said').textContent = `The same bodies meet ${common} times. The times of the first impacts differ by ${number(10 ** points[0][1], 2)} s, those of the last ones by ${number(10 ** points[points.length - 1][1], 2)} s.`;
}

async function check_proof() {
  const {case: text, events} = read('proven');
  $('prove-said').textContent = 'Running.';
  const {answer} = await judging.ask({what: 'first_impacts', text, settings: [], most: events.length});
  if (answer.problems) return void ($('prove-said').textContent = answer.problems.join(' '));
  const pair = (a, b) => b < 0 ? `${a} ${b}` : `${Math.min(a, b)} ${Math.max(a, b)}`;
  const agrees = k => pair(answer.ball[k], answer.partner[k]) === pair(events[k][1], events[k][2]);
  let right = 0;
  while (right < events.length && agrees(right)) ++right;
  // Decimals to 17 digits are doubles, so that the difference is that of the run.
  const digits = k => Math.min(16, -Math.log10(Math.abs(answer.time[k] - Number(events[k][0])) / Number(events[k][0])));
  const worst = Math.min(...Array.from({length: right}, (_, k) => digits(k)));
  $('prove-said').textContent = `${right} of ${events.length} impacts are those that are proven, in their order. Times are correct to ${digits(0).toFixed(1)} digits at first, and to ${worst.toFixed(1)} at worst.`;
}

async function check_certificate(certificate) {
  $('certificate-said').textContent = 'Checking.';
  const {answer, milliseconds} = await judging.ask({what: 'check', certificate});
  $('certificate-said').textContent = answer.problems ? `No certificate: ${answer.problems.join(' ')}` : `${answer.verdict} (${number(milliseconds / 1000, 2)} s)`;
}

/// The same with another last digit in the time of its eighth impact.
function forged(certificate) {
  const lines = certificate.split('\n');
  lines[8] = lines[8].replace(/"time":"([0-9a-f]+)/, (all, digits) => all.slice(0, -1) + (digits.endsWith('1') ? '2' : '1'));
  return lines.join('\n');
}

async function check_own_certificate() {
  try {
    await check_certificate(await bytes_of('own-certificate', 'a certificate'));
  } catch (error) {
    $('certificate-said').textContent = error.message;
  }
}

$('certificate').addEventListener('click', () => check_certificate(read('certificate-text')));
$('forged').addEventListener('click', () => check_certificate(forged(read('certificate-text'))));
$('own-certificate').addEventListener('change', check_own_certificate);
$('flight-time').addEventListener('input', show_flight);
$('gap-step').addEventListener('click', search_step);
$('gap-again').addEventListener('click', begin_search);
$('law').addEventListener('input', show_law);
on_submit('law', () => {});
$('diverge').addEventListener('click', diverge);
$('prove').addEventListener('click', check_proof);
show_flight();
begin_search();
show_law();
