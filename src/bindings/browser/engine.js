'use strict';
// Engines, each in a worker of its own: the mill continues while a log is judged. Answers come in
// the order of the questions.

const $ = id => document.getElementById(id);
const read = id => JSON.parse($(id).textContent);

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
    return this.ready ??= this.load();
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
  /// Ends the current task; the next question starts a new worker.
  stop() {
    this.worker?.terminate();
    this.ready = null;
    for (const resolve of this.waiting.splice(0)) resolve({answer: {problems: ['stopped']}, milliseconds: 0});
  }
}

const mill = new Engine(), judging = new Engine();
judging.stage = stage => { $('verdict').textContent = `Searching: ${stage}.`; };
const ask = message => mill.ask(message);
