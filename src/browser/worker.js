
// The engine in a worker: the page never waits for it. Each message is answered by one of the same `what`; a `stage` may come before.
let engine;

function call(name, types = [], values = []) {
  return JSON.parse(engine.ccall(name, 'string', types, values));
}

const answers = {
  begin: ({text, settings, log}) => call('edmill_begin', ['string', 'string', 'number'], [text, settings.join('\n'), log ? 1 : 0]),
  advance: ({time}) => call('edmill_advance', ['number'], [time]),
  first_impacts: ({text, settings, most}) => call('edmill_first_impacts', ['string', 'string', 'number'], [text, settings.join('\n'), most]),
  finish: () => call('edmill_finish'),
  audit: ({text, settings, log, identify}) => {
    engine.FS.writeFile('/log', log);
    return call('edmill_audit', ['string', 'string', 'number'], [text, settings.join('\n'), identify ? 1 : 0]);
  },
  check: ({certificate}) => {
    engine.FS.writeFile('/certificate', certificate);
    return call('edmill_check');
  },
  compare: ({reference, log}) => {
    engine.FS.writeFile('/reference', reference);
    engine.FS.writeFile('/log', log);
    return call('edmill_compare');
  },
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
    postMessage({what: data.what, answer: {problems: [`the engine stopped: ${error.message || error}`]}, milliseconds: 0});
  }
};
