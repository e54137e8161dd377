// Tests that fail, for waiting.mjs: each leaves a process of its own running, as a failed test of a run does.
import {spawn} from 'node:child_process';
import {scratch, startProgram, test, until} from './support.mjs';

const folder = scratch();
const sleeper = () => startProgram(folder, 'sh', '-c', 'sleep 1000 & wait');

test('throws', async () => {
  sleeper();
  throw new Error('out of luck');
});

test('waits in vain', async () => {
  sleeper();
  await until('the thaw', () => false);
});

test('waits in vain for one at work', async () => {
  startProgram(folder, 'sh', '-c', 'while :; do :; done');
  await until('the harvest', () => false);
});

test('waits for a command that has ended', async () => {
  startProgram(folder, 'sh', '-c', 'echo no such road >&2; exit 3');
  await until('the arrival', () => false);
});

test('awaits what never comes', async () => {
  sleeper();
  await until('the ferry', () => true);
  await new Promise(() => {});
});

if (process.argv.includes('--block'))
  test('blocks', async () => {
    sleeper();
    await until('the night', () => true);
    spawn('sleep', ['1000']);
    setTimeout(() => Atomics.wait(new Int32Array(new SharedArrayBuffer(4)), 0, 0), 10);
    await new Promise(() => {});
  });
