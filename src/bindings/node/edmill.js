#!/usr/bin/env node
// The command: edmill compiled to WebAssembly, with the files, standard input and exit codes of the
// program.
'use strict';

const [major] = process.versions.node.split('.').map(Number);
if (major < 18) {
  process.stderr.write(`edmill: node ${process.versions.node} is too old, 18 or later is needed\n`);
  process.exit(2);
}
// `edmill identify CASE LOG` is `edmill audit CASE LOG --identify`.
if (process.argv[2] === 'identify') process.argv.splice(2, 1, 'audit', '--identify');
const engine = require('fs').readFileSync(require('path').join(__dirname, 'engine.wasm'));
const tty = require('tty');
const settings = {
  arguments: process.argv.slice(2),
  thisProgram: 'edmill',
  wasmBinary: engine,
  preRun: [module => Object.assign(module.ENV, process.env)],
  onRuntimeInitialized: () => [0, 1, 2].forEach(descriptor => { settings.FS.streams[descriptor].tty = tty.isatty(descriptor); }),
};
require('./engine.js')(settings);
