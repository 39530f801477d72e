// The steps of the page's run, with an engine that answers at once and takes the time that it is
// given: at a pace, paused, impact by impact, and then to the end.
//
// usage: node steps_test.js SOURCE
'use strict';
const assert = require('assert'), fs = require('fs'), path = require('path'), vm = require('vm');

class Element {
  value = '';
  textContent = '';
  listeners = {};
  addEventListener(what, f) { this.listeners[what] = f; }
  click() { return this.listeners.click(); }
  append() {}
  replaceChildren() {}
}

/// The page with an engine that needs `cost` milliseconds for a second of the run.
function page_with(cost) {
  const elements = new Proxy({}, {get: (made, id) => made[id] ??= new Element()}), steps = [];
  let now = 0, time = 0, impacts = 0;
  const context = vm.createContext({
    $: id => elements[id], read: () => ({demo: ''}), scene: null, frame: null, rates: [], last_dose: [0, 0], console,
    document: {createElement: () => new Element(), addEventListener() {}}, Option: Element, draw() {}, show_facts() {}, view: {listen() {}},
    take(answer) { context.frame = answer; }, mill: {start: async () => {}, stop() {}}, judging: {stop() {}}, matchMedia: () => ({matches: true}),
    requestAnimationFrame: picture => setImmediate(() => picture(now += 16)),
    ask: async message => {
      if (message.what === 'begin') return {answer: {walls: {}, values: {}, version: ''}};
      if (message.what !== 'advance') return {answer: {}};
      const step = message.time < 0 ? 1e-4 : message.time - time;
      steps.push(step);
      time += step;
      return {answer: {time, impacts: ++impacts, ended: time > 1e6}, milliseconds: cost * step};
    },
  });
  vm.runInContext(fs.readFileSync(path.join(process.argv[2], 'src/bindings/browser/page.js'), 'utf8'), context);
  return {elements, steps};
}

const pictures = async count => { for (let k = 0; k < 3 * count; ++k) await new Promise(setImmediate); };

async function run(cost, before) {
  const {elements, steps} = page_with(cost);
  await pictures(1);
  elements.pace.value = '1';
  elements.choices.listeners.submit({preventDefault() {}});
  await pictures(20);
  await before(elements);
  const first = steps.length;
  elements.pace.value = '1';
  elements.end.click();
  await pictures(60);
  const free = steps.slice(first + 1);
  assert(free.length > 20, `${free.length} steps`);
  for (let k = 0; k < free.length; ++k) {
    assert(Number.isFinite(free[k]) && free[k] > 0, `a step of ${free[k]} s`);
    // A step takes a tenth of a second at most, but for the first ones.
    assert(cost * free[k] < 100 || free[k] <= 0.06 || free[k] <= free[k - 1], `step ${k} of ${free[k]} s at ${cost} ms for a second`);
  }
}

(async () => {
  for (const cost of [0.5, 20, 1000]) {
    await run(cost, async () => {});
    await run(cost, () => pictures(300));  // at the pace
    await run(cost, async elements => { elements.pause.click(); for (let k = 0; k < 200; ++k) { elements.step.click(); await pictures(1); } });
  }
  console.log('steps of the page take a tenth of a second at most, whatever came before');
  process.exit(0);  // the pages go on
})().catch(error => { console.error(error); process.exit(1); });
