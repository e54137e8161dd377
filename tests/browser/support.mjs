// What the browser tests share: a scratch folder, the drape command, Chromium, and pixels.
import {execFileSync, spawn} from 'node:child_process';
import fs from 'node:fs';
import {createRequire} from 'node:module';
import os from 'node:os';
import path from 'node:path';

const {chromium} = createRequire(path.join(process.env.DRAPE_NODE_MODULES, '/'))('playwright-core');
const drape = path.join(process.env.DRAPE_BIN, 'drape');
const source = path.resolve(path.dirname(new URL(import.meta.url).pathname), '../..');

export const contactConfig = path.join(source, 'tests/configs/data/contact.yaml');

export function scratch() {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'drape_browser_'));
  process.on('exit', () => fs.rmSync(folder, {recursive: true, force: true}));
  return folder;
}

/// Runs the command to its end; throws if it does not end well.
export function run(folder, ...args) {
  return execFileSync(drape, args, {cwd: folder, encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe']});
}

/// Starts it; `ended` resolves to {code, out, err}.
export function start(folder, ...args) {
  const child = spawn(drape, args, {cwd: folder, stdio: ['ignore', 'pipe', 'pipe']});
  const text = {out: '', err: ''};
  child.stdout.on('data', data => { text.out += data; });
  child.stderr.on('data', data => { text.err += data; });
  const ended = new Promise(resolve => child.on('close', code => resolve({code, ...text})));
  process.on('exit', () => child.kill('SIGKILL'));
  return {child, text, ended};
}

export async function until(what, condition, seconds = 20) {
  const end = Date.now() + 1000 * seconds;
  for (;;) {
    const value = await condition();
    if (value) return value;
    if (Date.now() > end) throw new Error(`not within ${seconds} s: ${what}`);
    await new Promise(resolve => setTimeout(resolve, 50));
  }
}

export async function browser() {
  return chromium.launch({
    executablePath: process.env.DRAPE_CHROMIUM || '/usr/bin/chromium',
    args: ['--headless=new', '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
      '--disable-background-networking', '--disable-component-update', '--disable-sync', '--no-first-run'],
  });
}

/// A page that takes down everything it complains about and every address it asks for.
export async function openPage(chrome, url, options = {}) {
  const context = await chrome.newContext({viewport: {width: 1200, height: 900}, ...options});
  const page = await context.newPage();
  const heard = {errors: [], requests: []};
  page.on('console', message => { if (['error', 'warning'].includes(message.type())) heard.errors.push(message.text()); });
  page.on('pageerror', error => heard.errors.push(String(error)));
  page.on('request', request => heard.requests.push(request.url()));
  await page.goto(url);
  await page.locator('#viewer').scrollIntoViewIfNeeded();
  await until('a state is shown', async () => {
    if (heard.errors.length) throw new Error(heard.errors.join('; '));
    return page.evaluate(() => window.drapeViewer && window.drapeViewer.state().panels.length > 0);
  });
  return {page, heard, state: () => page.evaluate(() => window.drapeViewer.state())};
}

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
