// Tests that fail end soon, say what they waited for, and leave nothing running.
import assert from 'node:assert/strict';
import path from 'node:path';
import {scratch, startProgram, test} from './support.mjs';

const folder = scratch(), failing = path.join(path.dirname(new URL(import.meta.url).pathname), 'failing.mjs');

/// The failing tests in limits of their own: a factor of the patience, and the time that the whole may be idle [s].
function failed(patience, idle, ...options) {
  return startProgram(folder, 'env', 'DRAPE_TEST_PATIENCE=' + patience, process.env.DRAPE_LIMITED, '60', idle, process.execPath,
    failing, ...options).ended();
}

test('a failed test says what it waited for, and ends what it has started', async () => {
  const {code, out, err} = await failed('0.025', '60');
  assert.equal(code, 1);
  assert.equal(err, '');  // drape_limited lists what a test has left running
  assert.match(out, /not ok 1 - throws\n[^]*out of luck/);
  assert.match(out, /not ok 2 - waits in vain\n[^]*in vain for 1 s of idle time: the thaw/);
  assert.match(out, /not ok 3 - waits in vain for one at work\n[^]*in vain for [0-9]+ looks and 0.25 s of work: the harvest/);
  assert.match(out, /not ok 4 - waits for a command that has ended\n[^]*has ended with 3 before: the arrival[^]*no such road/);
  assert.match(out, /not ok 5 - awaits what never comes\n[^]*in vain for 1 s of idle time: the step after: the ferry/);
});

test('a test that is ended from outside says what it waits for, and what it has started ends with it', async () => {
  const {code, err} = await failed('1', '1');
  assert.equal(code, 124);
  assert.match(err, /the test hangs: was idle for 1 s\. Its processes:\n[^]*sleep 1000/);
  assert.match(err, /SIGTERM in "waits in vain", waiting for: the thaw/);
});

test('what a blocked test has started ends with it', async () => {
  const {code, err} = await failed('0.025', '8', '--block');
  assert.equal(code, 124);
  assert.match(err, /left processes running, which were ended:\n[^]*sleep 1000/);
});
