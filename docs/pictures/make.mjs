// Makes pictures of README and docs from a run of pcs and newton, with its report: node docs/pictures/make.mjs RUN (see
// `make pictures`).
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import {browser, newPage, openPage, run, scratch} from '../../tests/browser/support.mjs';

const here = path.dirname(new URL(import.meta.url).pathname);
const results = path.resolve(process.argv[2]);
const methods = JSON.parse(fs.readFileSync(path.join(results, 'results.json'), 'utf8')).methods;
const folder = scratch();

/// Parts of the report as they look on the page.
async function reportPictures() {
  const {page} = await openPage('file://' + path.join(results, 'report.html'),
    {viewport: {width: 1100, height: 900}, deviceScaleFactor: 1.5});
  const picture = async (selector, name, margin = 12) => {
    await page.locator(selector).scrollIntoViewIfNeeded();
    await page.waitForTimeout(3000);  // charts move in, the viewer draws
    const box = await page.locator(selector).boundingBox();
    await page.screenshot({path: path.join(here, name), clip: {x: box.x - margin, y: box.y - margin,
      width: box.width + 2 * margin, height: box.height + 2 * margin}});
  };
  await page.locator('#distance-target').selectOption('own');
  await picture('#distance .plot', 'speed_against_error.png');
  await picture('#in-3d', 'viewer.png');
}

/// A figure of the hero: a state as `drape export` draws it.
async function figure(name, caption, ...options) {
  await run(folder, 'export', results, '--to', name, ...options);
  return `<figure><img src="${name}" alt=""><figcaption>${caption}</figcaption></figure>`;
}

async function levelsOf(method) {
  let all = '';
  for (const {level, vertices} of methods[method].levels)
    all += await figure(`${method}_l${level}.png`, `${vertices.toLocaleString('en-US')} vertices`, '--method', method, '--level',
      String(level), '--width', '900');
  return all;
}

function outlineOf(method, caption) {
  return figure(`${method}_outline.png`, caption, '--method', method, '--outline', '--width', '1200');
}

/// The levels of PCS above those of the direct method, and each preview's outline on its own fine result: 2400 pixels wide,
/// on the colour that is behind the cloth in every picture, which reads on light and dark pages.
async function hero() {
  const html = `<!DOCTYPE html><meta charset="utf-8"><style>
    body { margin: 0; background: #fbfbfb; color: #1b2027; font: 17px/1.3 "Noto Sans", "DejaVu Sans", sans-serif; }
    main { box-sizing: border-box; width: 1200px; padding: 12px 20px; background: #fbfbfb; }
    h2 { margin: 10px 0 4px; font-size: 20px; font-weight: 600; }
    div { display: grid; grid-template-columns: repeat(${methods.pcs.levels.length}, 1fr); gap: 12px; }
    div.outlines { grid-template-columns: 460px 460px; justify-content: space-evenly; }
    figure { margin: 0; text-align: center; color: #5a6472; }
    img { display: block; width: 100%; }
    </style><main>
    <h2>Progressive (PCS), coarse to fine</h2><div>${await levelsOf('pcs')}</div>
    <h2>Direct Newton, each level on its own</h2><div>${await levelsOf('newton')}</div>
    <h2>Outline of the coarsest level, in blue, on the finest</h2>
    <div class="outlines">${await outlineOf('pcs', 'progressive')}${await outlineOf('newton', 'direct')}</div></main>`;
  fs.writeFileSync(path.join(folder, 'hero.html'), html);
  const page = await newPage({viewport: {width: 1200, height: 900}, deviceScaleFactor: 2});
  await page.goto('file://' + path.join(folder, 'hero.html'));
  await page.locator('main').screenshot({path: path.join(here, 'hero.png')});
}

/// The snapshots of PCS, coarse to fine, as an animation that rests at the end of every level.
async function progression() {
  const most = 3e6;  // [bytes]
  await run(folder, 'export', results, '--to', 'frame.png', '--method', 'pcs', '--frames', '--width', '640');
  const frames = fs.readdirSync(folder).filter(name => name.startsWith('frame_')).sort();
  const ends = new Set();
  methods.pcs.levels.reduce((count, level) => {
    ends.add(count + level.snapshots.iterations.length - 1);
    return count + level.snapshots.iterations.length;
  }, 0);
  const milliseconds = k => k === frames.length - 1 ? 2500 : ends.has(k) ? 900 : 200;
  const file = path.join(here, 'progression.webp');
  for (const quality of [80, 60, 40]) {
    execFileSync('img2webp', ['-loop', '0', '-lossy', '-q', String(quality), '-m', '6',
      ...frames.flatMap((name, k) => ['-d', String(milliseconds(k)), name]), '-o', file], {cwd: folder, stdio: 'pipe'});
    if (fs.statSync(file).size < most) return;
  }
  throw new Error(`${file} is larger than ${most} bytes`);
}

await reportPictures();
await hero();
await progression();
await (await browser()).close();
