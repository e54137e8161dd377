// Makes the README's pictures from a report: node docs/pictures/make.mjs REPORT.html (see `make pictures`).
import path from 'node:path';
import {browser, openPage} from '../../tests/browser/support.mjs';

const here = path.dirname(new URL(import.meta.url).pathname);
const report = 'file://' + path.resolve(process.argv[2]);
const chrome = await browser();
const {page} = await openPage(chrome, report, {viewport: {width: 1100, height: 900}, deviceScaleFactor: 1.5});
const picture = async (selector, name, margin = 12) => {
  await page.locator(selector).scrollIntoViewIfNeeded();
  await page.waitForTimeout(3000);  // charts move in, the viewer draws
  const box = await page.locator(selector).boundingBox();
  await page.screenshot({path: path.join(here, name), clip: {x: box.x - margin, y: box.y - margin,
    width: box.width + 2 * margin, height: box.height + 2 * margin}});
};
await page.locator('#error-target').selectOption('own');
await picture('#errors-section .charts', 'speed_against_error.png');
await picture('#viewer', 'viewer.png');
await chrome.close();
