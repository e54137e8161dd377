// Pictures of README and docs, by `make pictures`: node docs/pictures/make.mjs SPHERE RUNS [PART,...], with a run of the study sphere and
// the folder for runs of its own, which stay there for another call.
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import {browser, newPage, openPage, run, scratch} from '../../tests/browser/support.mjs';

const here = path.dirname(new URL(import.meta.url).pathname), root = path.resolve(here, '../..');
const sphere = path.resolve(process.argv[2]);
const runs = path.resolve(process.argv[3]);
const folder = scratch();
const drape = (...options) => execFileSync(path.join(process.env.DRAPE_BIN, 'drape'), options, {cwd: root, stdio: 'inherit'});

const preview = ['--levels', '3', '--method', 'pcs'];
const galleryRuns = {
  bunny_shawl: ['configs/bunny_shawl.yaml', ...preview],
  armadillo: ['configs/armadillo.yaml', ...preview],
  cube: ['configs/cube.yaml', ...preview],
  materials_6: ['configs/materials_6.yaml', ...preview],
  pinned_square: ['configs/pinned_square.yaml', ...preview],
  cusick: ['configs/tests/cusick.yaml', ...preview],
  ribbon: ['configs/ribbon.yaml', '--method', 'pcs'],
  handkerchief: ['configs/handkerchief.yaml', '--method', 'pcs'],
  curtain: [path.join(runs, 'my_curtain.yaml')],
};
const otherRuns = {
  folded: ['configs/hard/folded.yaml', '--method', 'newton'],
  tablecloth: ['configs/tablecloth.yaml', ...preview],
  locking: ['configs/sphere.yaml', '--levels', '3', '--method', 'pcs,pcs_loop,unrelaxed,cascadic',
    '--set', 'methods.unrelaxed={type: pcs, relaxation: none}'],
  lone_pins: ['configs/pinned_square.yaml', '--set', 'cloth.columns=20', '--set', 'cloth.rows=20', '--method', 'pcs,plain',
    '--set', 'methods.plain={type: pcs, membranes: plain}'],
};

/// The guide's experiment, also with other patterns.
const garmentRuns = Object.fromEntries(['tshirt', 'shirt', 'skirt', 'trousers'].map(name => [name, [path.join(runs, `my_${name}.yaml`)]]));
const heldAtWaist = ['skirt', 'trousers'];

/// Of the cloth, in pictures that are drawn before a light and a dark backdrop.
const colours = {
  tablecloth: 'a63d40', bunny_shawl: '3f8f8b', armadillo: 'c98a2b', cube: '3a6ea5', materials_6: '8e5572', pinned_square: '6f8f5a',
  ribbon: 'c23b3b', cusick: 'b9b4a8', handkerchief: 'e3e0d8', curtain: 'c7a94f', tshirt: 'd9734e', shirt: '86a8cf', skirt: '7d4a78',
  trousers: '44546f',
};
const backdrops = [{suffix: '', options: [], page: '#fbfbfb', text: '#1b2027'},
  {suffix: '_dark', options: ['--dark'], page: '#171b21', text: '#e6e9ee'}];

const build = execFileSync(path.join(process.env.DRAPE_BIN, 'drape'), ['--version'], {encoding: 'utf8'}).match(/\((.*)\)/)[1];

function hasRun(results) {
  if (!fs.existsSync(path.join(results, 'results.json'))) return false;
  const {complete, commit} = JSON.parse(fs.readFileSync(path.join(results, 'results.json'), 'utf8'));
  return complete && commit === build;
}

/// The folder of a run's results, which is run unless it has some of this build; the curtain's experiment is the README's own.
function resultsOf(name) {
  const results = path.join(runs, name);
  if (hasRun(results)) return results;
  if (name === 'curtain') {
    const readme = fs.readFileSync(path.join(root, 'README.md'), 'utf8');
    fs.writeFileSync(path.join(runs, 'my_curtain.yaml'), readme.match(/```yaml my_curtain.yaml\n(.*?)```/s)[1]);
  }
  if (name in garmentRuns) {
    execFileSync(path.join(root, 'configs/garments/make_body'), [path.join(runs, 'figure.obj')], {stdio: 'inherit'});
    const guide = fs.readFileSync(path.join(root, 'docs/guide/dress.md'), 'utf8');
    fs.copyFileSync(path.join(root, `configs/garments/${name}.yaml`), path.join(runs, `${name}.yaml`));
    fs.writeFileSync(path.join(runs, `my_${name}.yaml`), guide.match(/```yaml my_tshirt.yaml\n(.*?)```/s)[1].replaceAll('tshirt', name) +
      (heldAtWaist.includes(name) ? 'pins: [{region: label, label: waist}]\n' : ''));
  }
  drape('run', ...{...galleryRuns, ...otherRuns, ...garmentRuns}[name], '-o', results, '--overwrite', '--no-report');
  return results;
}

/// A part of a run's report as it looks on the page.
async function reportPart(results, selector, name, margin = 12) {
  drape('report', results);
  const {page} = await openPage('file://' + path.join(results, 'report.html'),
    {viewport: {width: 1100, height: 900}, deviceScaleFactor: 1.5});
  if (selector.startsWith('#distance')) await page.locator('#distance-target').selectOption('own');
  await page.locator(selector).scrollIntoViewIfNeeded();
  await page.waitForTimeout(3000);  // charts move in, the viewer draws
  const box = await page.locator(selector).boundingBox();
  const file = path.join(folder, `${name}.png`);
  await page.screenshot({path: file, clip: {x: box.x - margin, y: box.y - margin, width: box.width + 2 * margin,
    height: box.height + 2 * margin}});
  execFileSync('cwebp', ['-quiet', '-q', '88', file, '-o', path.join(here, `${name}.webp`)]);
}

const plot = () => reportPart(sphere, '#distance .plot', 'speed_against_error', 0);
const viewer = () => reportPart(resultsOf('tablecloth'), '#in-3d', 'viewer');

/// A state as `drape export` draws it, half as wide, so that edges are smooth.
async function still(results, name, width, ...options) {
  const file = path.join(folder, `${name}.png`);
  await run(folder, 'export', results, '--to', file, '--width', String(2 * width), '--overwrite', ...options);
  execFileSync('cwebp', ['-quiet', '-q', '92', '-resize', String(width), '0', file, '-o', path.join(here, `${name}.webp`)]);
}

/// Before both backdrops, in a scene's own colour.
async function coloured(scene, name, width, ...options) {
  for (const backdrop of backdrops)
    await still(resultsOf(scene), name + backdrop.suffix, width, '--colour', colours[scene], ...backdrop.options, ...options);
}

/// The finest states of the gallery, some from a side that shows more than the report's.
async function gallery() {
  const views = {bunny_shawl: '--view=-0.5,-1,0.6', ribbon: '--view=0.3,-1,0.5'};
  for (const name of Object.keys(galleryRuns))
    await coloured(name, name, name === 'bunny_shawl' ? 640 : 480, ...(views[name] ? [views[name]] : []));
  await still(resultsOf('folded'), 'folded', 480);
  await coloured('bunny_shawl', 'bunny_shawl_l0', 640, views.bunny_shawl, '--level', '0');
}

/// Levels beside each other in pages: the coarsest and the finest of the sphere, all of the locking's, previews at lone pins and their end.
async function levels() {
  for (const method of ['pcs', 'cascadic', 'newton'])
    for (const level of ['0', '3']) await still(sphere, `sphere_${method}_l${level}`, 480, '--method', method, '--level', level);
  for (const method of ['pcs', 'pcs_loop', 'unrelaxed', 'cascadic'])
    for (const level of ['0', '1', '2'])
      await still(resultsOf('locking'), `locking_${method}_l${level}`, 480, '--method', method, '--level', level);
  for (const [method, level] of [['plain', '0'], ['pcs', '0'], ['pcs', '3']])
    await still(resultsOf('lone_pins'), `lone_pins_${method}_l${level}`, 480, '--method', method, '--level', level, '--view=1,-2,0.15');
}

async function garments() {
  for (const name of Object.keys(garmentRuns)) await coloured(name, name, name === 'tshirt' ? 640 : 480);
}

const seconds = s => s < 9.95 ? s.toFixed(1) : s.toFixed(0);
const thousands = n => (n / 1000).toFixed(n < 9950 ? 1 : 0);

/// The snapshots of the tablecloth as an animation that rests at the end of every level. Each frame has its clock and its number of
/// vertices, and the last one those of all levels.
async function progression() {
  for (const backdrop of backdrops) await animation(backdrop);
}

async function animation(backdrop) {
  const results = resultsOf('tablecloth');
  const all = JSON.parse(fs.readFileSync(path.join(results, 'results.json'), 'utf8')).methods.pcs.levels;
  await run(folder, 'export', results, '--to', 'frame.png', '--frames', '--width', '1280', '--view=0.5,-1,0.5',
    '--colour', colours.tablecloth, '--overwrite', ...backdrop.options);
  const names = fs.readdirSync(folder).filter(name => /^frame_.*png$/.test(name)).sort();
  const page = await newPage({viewport: {width: 640, height: 700}});
  const frames = [], ends = [];
  for (const level of all) {
    for (const at of level.snapshots.seconds) {
      const end = at === level.snapshots.seconds.at(-1);
      const clock = `${seconds(at)} s`, count = `${thousands(level.vertices)}K`;
      if (end) ends.push(`${clock}, ${count}`);
      const name = names.shift();
      const label = end && ends.length === all.length ? ends.join(' … ') + ' vertices' : `${clock}, ${count} vertices`;
      fs.writeFileSync(path.join(folder, 'frame.html'), `<!DOCTYPE html><meta charset="utf-8"><style>
        body { margin: 0; background: ${backdrop.page}; }
        main { position: relative; width: 640px; height: 498px; overflow: hidden; }
        img { display: block; width: 640px; }
        p { position: absolute; left: 14px; top: 8px; margin: 0; color: ${backdrop.text}; font: 600 22px "Noto Sans", "DejaVu Sans", sans-serif; }
        </style><main><img src="${name}"><p>${label}</p></main>`);
      await page.goto('file://' + path.join(folder, 'frame.html'));
      await page.locator('main').screenshot({path: path.join(folder, `drawn_${name}`)});
      frames.push('-d', String(end ? (ends.length === all.length ? 4000 : 1500) : 200), `drawn_${name}`);
    }
  }
  execFileSync('img2webp', ['-loop', '0', '-lossy', '-q', '74', '-m', '6', ...frames, '-o', path.join(here, `tablecloth${backdrop.suffix}.webp`)],
    {cwd: folder, stdio: 'pipe'});
}

fs.mkdirSync(runs, {recursive: true});
const parts = {plot, viewer, levels, gallery, garments, progression};
for (const name of process.argv[4] ? process.argv[4].split(',') : Object.keys(parts)) await parts[name]();
await (await browser()).close();
