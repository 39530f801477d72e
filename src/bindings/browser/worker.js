
// The engine in a worker: the page never waits for it. Each message is answered by one of the same
// `what`; a `stage` may come before.
let engine;

/// Texts of any length are files of the engine's own memory: its stack is short.
function call(name, number, files = {}) {
  for (const [file, content] of Object.entries(files)) engine.FS.writeFile(`/${file}`, content);
  const types = number === undefined ? [] : ['number'];
  return JSON.parse(engine.ccall(name, 'string', types, types.length ? [Number(number)] : []));
}

const of_case = ({text, settings}) => ({case: text, settings: settings.join('\n')});
const answers = {
  begin: message => call('edmill_begin', message.log, of_case(message)),
  advance: ({time}) => call('edmill_advance', time),
  first_impacts: message => call('edmill_first_impacts', message.most, of_case(message)),
  case: () => call('edmill_case'),
  machines: () => call('edmill_machines'),
  new: ({wanted}) => call('edmill_new', undefined, {wanted: wanted.join('\n')}),
  finish: () => call('edmill_finish'),
  audit: message => call('edmill_audit', message.identify, {...of_case(message), log: message.log}),
  check: ({certificate}) => call('edmill_check', undefined, {certificate}),
  compare: ({reference, log}) => call('edmill_compare', undefined, {reference, log}),
};

onmessage = async ({data}) => {
  try {
    if (data.what === 'engine') {
      engine = await Edmill({wasmBinary: data.engine, print: () => {}, printErr: () => {}});
      postMessage({what: 'engine'});
      return;
    }
    const begin = performance.now();
    const answer = answers[data.what](data);
    postMessage({what: data.what, answer, milliseconds: performance.now() - begin});
  } catch (error) {
    postMessage({what: 'trap', answer: {problems: [`the engine stopped: ${error.message || error}`]}, milliseconds: 0});
  }
};
