// What the browser tests share: tests that end what they start, the drape command, Chromium, and pixels.
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import fs from 'node:fs';
import {createRequire} from 'node:module';
import os from 'node:os';
import path from 'node:path';
import nodeTest, {after} from 'node:test';

const drape = path.join(process.env.DRAPE_BIN, 'drape');
export const source = path.resolve(path.dirname(new URL(import.meta.url).pathname), '../..');

export const contactConfig = path.join(source, 'tests/configs/data/contact.yaml');

/// The most that a step of a test may take in its processes' time, as tests/support/limited.cpp measures it [s]; without limits
/// by hand. And what is enough for an event to come: so many looks, and so much work of the commands that run [s].
const factor = Number(process.env.DRAPE_TEST_PATIENCE || 1);
const patience = {cpu: 100 * factor, idle: 40 * factor, looks: 30 * factor, work: 10 * factor};
let at = {test: '', step: '', begun: taken()};
const commands = new Set(), complaints = [];  // of pages from the disk in the test under way
let chrome, closes = false;

function taken() {
  const file = process.env.DRAPE_TEST_TIME;
  const [cpu, idle] = file ? fs.readFileSync(file, 'utf8').trim().split(/\s+/).map(Number) : [0, 0];
  return {cpu, idle};
}

function begin(step) {
  at = {...at, step, begun: taken()};
}

function excess() {
  const now = taken();
  for (const what of ['cpu', 'idle'])
    if (now[what] - at.begun[what] > patience[what]) return `${patience[what]} s of ${what === 'cpu' ? 'processor' : 'idle'} time`;
  return '';
}

/// Runs part of a test. It fails when a step of it exceeds the patience, and names the step; what it has started ends with it.
export async function guarded(name, body) {
  at = {test: name};
  complaints.length = 0;
  begin('its beginning');
  let timer;
  const overdue = new Promise((_, reject) => {
    timer = setInterval(() => { if (excess()) reject(new Error(`in vain for ${excess()}: ${at.step}`)); }, 200);
  });
  try {
    await Promise.race([body(), overdue]);
    if (complaints.length) throw new Error('a page complains: ' + complaints.join('; '));
  } finally {
    clearInterval(timer);
    at = {...at, test: ''};
    begin(`the end of what "${name}" has started`);
    endCommands();
    if (chrome) await Promise.all((await chrome).contexts().map(context => context.close()));
  }
}

/// node:test's `test`, guarded.
export function test(name, body) {
  if (!closes) after(async () => { if (chrome) await (await chrome).close(); });
  closes = true;
  nodeTest(name, () => guarded(name, body));
}

function endCommands() {
  for (const command of commands) command.kill('SIGKILL');
  commands.clear();
}

process.on('exit', endCommands);
for (const signal of ['SIGINT', 'SIGTERM', 'SIGHUP'])
  process.on(signal, () => {
    console.error(`${signal} in "${at.test}", waiting for: ${at.step}`);
    process.exit(1);
  });

/// Processor time of a process [s].
function processorTime(pid) {
  try {
    const fields = fs.readFileSync(`/proc/${pid}/stat`, 'utf8').replace(/^.*\) /s, '').split(' ');
    return (Number(fields[11]) + Number(fields[12])) / 100;
  } catch {
    return 0;  // it has ended
  }
}

/// Waits until the condition holds, which it looks up again and again, ever less often; the step ends then. Fails after enough looks
/// and enough work of the commands: both take longer on a busy machine, as the event itself does.
export async function until(step, condition, looks = patience.looks) {
  const {test} = at, begun = new Map([...commands].map(command => [command, processorTime(command.pid)]));
  begin(step);
  for (let look = 1, pause = 20; ; ++look, pause = Math.min(1.5 * pause, 500)) {
    const value = await condition();
    if (test !== at.test) throw new Error(`the test has ended: ${test}`);
    if (value) {
      begin('the step after: ' + step);
      return value;
    }
    for (const {line, result, awaited} of commands)
      if (result && !awaited) throw new Error(`${line} has ended with ${result.code} before: ${step}\n${result.err}`);
    if (look > looks && [...begun].every(([{pid, result}, time]) => result || processorTime(pid) > time + patience.work))
      throw new Error(`in vain for ${look} looks and ${patience.work} s of work: ${step}`);
    await new Promise(resolve => setTimeout(resolve, pause));
  }
}

export function scratch() {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'drape_browser_'));
  process.on('exit', () => fs.rmSync(folder, {recursive: true, force: true}));
  return folder;
}

/// Starts the command, in a process group of its own. `ended()` resolves to its {code, out, err}.
export function start(folder, ...args) {
  return startProgram(folder, drape, ...args);
}

export function startProgram(folder, program, ...args) {
  const child = spawn(program, args, {cwd: folder, stdio: ['ignore', 'pipe', 'pipe'], detached: true});
  const command = {pid: child.pid, line: [path.basename(program), ...args].join(' '), text: {out: '', err: ''}, result: null, awaited: false};
  command.kill = signal => {
    try { process.kill(-child.pid, signal); } catch { /* it has ended */ }
  };
  command.ended = () => {
    command.awaited = true;
    return until('the end of: ' + command.line, () => command.result, Infinity);
  };
  child.stdout.on('data', data => { command.text.out += data; });
  child.stderr.on('data', data => { command.text.err += data; });
  child.on('close', code => { command.result = {code, ...command.text}; });
  commands.add(command);
  return command;
}

/// Runs the command to its end; throws if it does not end well.
export async function run(folder, ...args) {
  const command = start(folder, ...args);
  const {code, err} = await command.ended();
  commands.delete(command);
  if (code !== 0) throw new Error(`${command.line} has ended with ${code}:\n${err}`);
}

/// Chromium, one for all tests of a file.
export function browser() {
  const {chromium} = createRequire(path.join(process.env.DRAPE_NODE_MODULES, '/'))('playwright-core');
  chrome ??= chromium.launch({
    executablePath: process.env.DRAPE_CHROMIUM || '/usr/bin/chromium', timeout: 0,
    args: ['--headless=new', '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
      '--disable-background-networking', '--disable-component-update', '--disable-sync', '--no-first-run'],
  });
  return chrome;
}

export async function newPage(options = {}) {
  const context = await (await browser()).newContext(options);
  context.setDefaultTimeout(0);  // the step's patience is the limit
  return context.newPage();
}

/// Takes down everything that a page complains about and every address that it asks for. A page from the disk that complains fails
/// the test.
export function listenTo(page) {
  const heard = {errors: [], requests: []};
  const complain = text => {
    heard.errors.push(text);
    if (page.url().startsWith('file:')) complaints.push(text);
  };
  page.on('console', message => { if (['error', 'warning'].includes(message.type())) complain(message.text()); });
  page.on('pageerror', error => complain(String(error)));
  page.on('request', request => heard.requests.push(request.url()));
  return heard;
}

/// A page with a 3D view that shows a state, and what is heard of it.
export async function openPage(url, options = {}) {
  const page = await newPage({viewport: {width: 1200, height: 900}, ...options}), heard = listenTo(page);
  await page.goto(url);
  await page.locator('#viewer').scrollIntoViewIfNeeded();
  await until('a state is shown', async () => {
    if (heard.errors.length) throw new Error(heard.errors.join('; '));
    return page.evaluate(() => window.drapeViewer && window.drapeViewer.state().panels.length > 0);
  });
  return {page, heard, state: () => page.evaluate(() => window.drapeViewer.state())};
}

/// Checks that a page, with all of it unfolded and so many plots drawn, fits its width and has no serious fault; closes it.
export async function checkWhole(page, plots) {
  await page.evaluate(() => document.querySelectorAll('details').forEach(part => { part.open = true; }));
  await until('the plots are drawn', async () => await page.evaluate(() => document.querySelectorAll('.plot svg').length) >= plots);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
  assert.deepEqual(await faultsOf(page), []);
  await page.context().close();
}

/// Serious faults of accessibility that axe-core finds in a page.
async function faultsOf(page) {
  const {source} = createRequire(path.join(process.env.DRAPE_NODE_MODULES, '/'))('axe-core');
  await page.evaluate(source);
  const {violations} = await page.evaluate(() => window.axe.run());
  return violations.filter(fault => ['serious', 'critical'].includes(fault.impact)).map(fault => `${fault.id}: ${fault.nodes.map(node => node.html).join(' ').slice(0, 300)}`);
}

/// Whether all of an element is on the first screen, and the page is no wider than the screen.
export function onFirstScreen(page, selector) {
  return page.evaluate(of => {
    const box = document.querySelector(of).getBoundingClientRect();
    return box.width > 0 && box.top >= 0 && box.bottom <= innerHeight && document.documentElement.scrollWidth <= innerWidth;
  }, selector);
}

/// What a press of a button downloads.
export async function downloaded(page, button) {
  const [download] = await Promise.all([page.waitForEvent('download'), page.locator(button).click()]);
  return {name: download.suggestedFilename(), bytes: fs.readFileSync(await download.path())};
}

export const screens = ['light', 'dark'].flatMap(colorScheme => [1200, 400].map(width => ({colorScheme, viewport: {width, height: 800}})));

/// The share of a screenshot of the element whose colour differs from its most frequent one.
export async function drawnShare(page, selector) {
  const png = (await page.locator(selector).screenshot()).toString('base64');
  return page.evaluate(async data => {
    const image = new Image();
    image.src = 'data:image/png;base64,' + data;
    await image.decode();
    const canvas = Object.assign(document.createElement('canvas'), {width: image.width, height: image.height});
    const pen = canvas.getContext('2d');
    pen.drawImage(image, 0, 0);
    const counts = new Map(), pixels = new Uint32Array(pen.getImageData(0, 0, image.width, image.height).data.buffer);
    for (const p of pixels) counts.set(p, (counts.get(p) || 0) + 1);
    return 1 - Math.max(...counts.values()) / pixels.length;
  }, png);
}
