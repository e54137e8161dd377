// A small run with contact, made before the tests of a file, and reports of it.
import fs from 'node:fs';
import path from 'node:path';
import {before} from 'node:test';
import {addressOf, contactConfig, jsonIn, openPage, run, scratch} from './support.mjs';

export const folder = scratch(), report = addressOf(folder, 'out/report.html');

/// The report of a folder of results, anew, with small pictures, which are drawn sooner.
export async function openReport(name) {
  await run(folder, 'report', name, '--width', '225');
  return openPage(addressOf(folder, name, 'report.html'));
}

export function runContact(name, ...options) {
  return run(folder, 'run', contactConfig, '--out', name, '--quiet', '--threads', '1', ...options);
}

export function changeResults(name, change) {
  const results = jsonIn(folder, name, 'results.json');
  change(results.methods, results);
  fs.writeFileSync(path.join(folder, name, 'results.json'), JSON.stringify(results));
}

/// The report of a copy of the run with other results.
export function edited(name, edit) {
  fs.cpSync(path.join(folder, 'out'), path.join(folder, name), {recursive: true});
  changeResults(name, edit);
  return openReport(name);
}

before(() => runContact('out', '--method', 'all', '--set', 'snapshots=0'));
