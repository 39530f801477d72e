// edmill for scripts. Each call runs the command in a process of its own, so that several run at
// once.
import {spawn} from 'node:child_process';
import {mkdtemp, readFile, rm} from 'node:fs/promises';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import path from 'node:path';
import {fileURLToPath} from 'node:url';

const program = fileURLToPath(new URL('./edmill.js', import.meta.url));
const commands = createRequire(import.meta.url)('./commands.json');

/** A command that failed; `code` is its exit code, the message what it printed. */
export class EdmillError extends Error {
  constructor(code, message) {
    super(message);
    this.code = code;
  }
}

/** Runs a command line. Resolves with its exit code and what it printed, whatever the code is. */
export function edmill(words, {input, cwd} = {}) {
  return new Promise((resolve, reject) => {
    const child = spawn(process.execPath, [program, ...words], {cwd});
    const texts = {stdout: '', stderr: ''};
    for (const name of ['stdout', 'stderr']) child[name].setEncoding('utf8').on('data', text => { texts[name] += text; });
    child.on('error', reject);
    child.on('close', code => resolve({code, ...texts}));
    child.stdin.on('error', () => {}); // it does not read its input
    child.stdin.end(input);
  });
}

/** `{gapTolerance: 1e-4, set: ['run.seed=2'], quiet: true}` as words of a command line. */
function words_of(command, options) {
  const words = [];
  for (const [name, value] of Object.entries(options)) {
    const option = name.replace(/[A-Z]/g, letter => '-' + letter.toLowerCase());
    if (!(option in commands[command].options)) throw new TypeError(`edmill ${command} has no option ${name}`);
    if (value === undefined || value === false) continue;
    for (const one of [value].flat()) words.push(`--${option}` + (one === true ? '' : `=${one}`));
  }
  return words;
}

/** Runs a command that writes its result as JSON. @param verdicts  exit codes with a result */
async function result_of(command, places, options, verdicts, with_result) {
  const {input, cwd, ...others} = options;
  const folder = await mkdtemp(path.join(tmpdir(), 'edmill-'));
  try {
    const {words, file} = with_result(folder, others);
    const {code, stdout, stderr} = await edmill([command, ...places, ...words], {input, cwd});
    if (!verdicts.includes(code)) throw new EdmillError(code, stderr.trim());
    return {...JSON.parse(await readFile(path.resolve(cwd ?? '.', file), 'utf8')), code, text: stdout};
  } finally {
    await rm(folder, {recursive: true, force: true});
  }
}

const judge = command => (a, b, options = {}) => result_of(command, [a, b], options, [0, 6, 7], (folder, others) => {
  const file = others.json ?? path.join(folder, 'result.json');
  return {file, words: words_of(command, {...others, json: file})};
});

/** Judges a log against the equations of a case. Resolves with the fields of `--json`. */
export const audit = judge('audit');
/** Compares a log with a reference. Resolves with the fields of `--json`. */
export const compare = judge('compare');

/** Simulates a case. Resolves with the fields of summary.json. Without `out` only these are kept. */
export const run = (file, options = {}) => result_of('run', [file], options, [0, 3, 4, 8], (folder, others) => {
  const out = others.out ?? path.join(folder, 'out');
  return {file: path.join(out, 'summary.json'), words: words_of('run', {...others, out})};
});

/** What a case is in SI, as text. */
export async function check(file, {input, cwd, ...options} = {}) {
  const {code, stdout, stderr} = await edmill(['check', file, ...words_of('check', options)], {input, cwd});
  if (code !== 0) throw new EdmillError(code, stderr.trim());
  return stdout;
}

/** Whether a certificate proves its events, and the sentence that says so. */
export async function certificate(file, {input, cwd} = {}) {
  const {code, stdout, stderr} = await edmill(['certificate', file], {input, cwd});
  if (code !== 0 && code !== 6) throw new EdmillError(code, stderr.trim());
  return {accepted: code === 0, text: stdout.trim()};
}
