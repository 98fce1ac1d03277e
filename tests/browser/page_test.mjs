// node page_test.mjs CHROMIUM FOLDER SHOTS: opens good.html, bad.html, path.html and zones.html of FOLDER from disk.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

const [executablePath, folder, shots] = process.argv.slice(2);
const profile = mkdtempSync(join(tmpdir(), 'gravure-browser-'));
const args = [
  '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update',
  '--disable-sync', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
];
const waiting = { timeout: 120_000 };
const said = JSON.parse(readFileSync(join(folder, 'good.json'), 'utf8'));
let checks = 0;
const check = (what, condition) => {
  assert.ok(condition, what);
  checks += 1;
};

/** Opens a page and collects whatever it complains of or asks the network for. */
async function open(context, name, layers = true) {
  const page = await context.newPage();
  const troubles = [];
  page.on('console', (message) => {
    if (message.type() === 'error') troubles.push(message.text());
  });
  page.on('pageerror', (error) => troubles.push(String(error)));
  page.on('dialog', (dialog) => {
    troubles.push(`dialog: ${dialog.message()}`);
    dialog.dismiss();
  });
  page.on('request', (request) => {
    if (!/^(file|data|blob):/.test(request.url())) troubles.push(`request: ${request.url()}`);
  });
  await page.goto(pathToFileURL(join(folder, name)).href, waiting);
  await page.waitForSelector('html[data-ready=true]', { state: 'attached', ...waiting });
  if (layers) await page.evaluate(() => gravure.layers.ready);
  return { page, troubles };
}

/** How many colours a canvas shows. */
const colours = (page, selector) => page.evaluate((which) => {
  const source = document.querySelector(which);
  const copy = document.createElement('canvas');
  copy.width = 80;
  copy.height = 60;
  const context = copy.getContext('2d');
  context.drawImage(source, 0, 0, copy.width, copy.height);
  const pixels = new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer);
  return new Set(pixels).size;
}, selector);
const picture = (page, selector) => page.evaluate((which) => document.querySelector(which).toDataURL(), selector);

async function goodPage(context, shot) {
  const { page, troubles } = await open(context, 'good.html');
  const data = await page.evaluate(() => gravure.data);
  check('the verdict stands on top', (await page.textContent('#verdict')).includes('Within limits'));
  // The seam: the number in the text, the limit line, the bound and the curve.
  const worst = await page.evaluate(() => gravure.number(gravure.data.seam.max_um, 6));
  check('the seam error is told', (await page.textContent('#seam')).includes(`${worst} µm`));
  check('the seam curve and its limits are drawn', (await page.locator('#seam path.seam').count()) === 1 && (await page.locator('#seam line.limit').count()) === 2 && (await page.locator('#seam path.bound').count()) === 2);
  await page.locator('#seam-chart > div').first().focus();
  await page.keyboard.press('ArrowLeft');
  const shown = await page.textContent('#seam-chart .readout');
  const point = await page.evaluate(() => gravure.number(gravure.data.seam.points[gravure.data.seam.points.length > 1 ? gravure.data.seam.points.length - 2 : 0][1], 6));
  check(`the keyboard reads the points: ${shown}`, shown.includes(`${point} µm`));
  // Layers: the slider changes the picture and the caption.
  const slider = page.locator('#layer-slider');
  const before = await picture(page, '#layers-canvas');
  check('the first layer is named', (await page.textContent('#layers-readout')).startsWith('Layer 0 '));
  await slider.focus();
  await page.keyboard.press('ArrowRight');
  await page.waitForFunction(() => document.querySelector('#layers-readout').textContent.startsWith('Layer 1 '), null, waiting);
  check('the slider shows another layer', (await picture(page, '#layers-canvas')) !== before);
  check(`the page shows all ${said.shown_layers} layers`, Number(await slider.getAttribute('max')) === said.shown_layers - 1);
  await page.locator('#layers-canvas').focus();
  const whole = await picture(page, '#layers-canvas');
  await page.keyboard.press('+');
  check('zooming changes the picture', (await picture(page, '#layers-canvas')) !== whole);
  await page.selectOption('#layers-where', 'seam');
  await page.evaluate(() => gravure.layers.ready);
  await page.waitForFunction(() => gravure.layers.picture && !gravure.layers.picture.whole, null, waiting);
  check('the seam is shown pixel by pixel', (await colours(page, '#layers-canvas')) > 2);
  await page.selectOption('#layers-what', 'depth');
  await page.waitForFunction(() => gravure.layers.picture.asDepth, null, waiting);
  await page.selectOption('#layers-where', 'whole');
  await page.waitForFunction(() => gravure.layers.picture.whole, null, waiting);
  // Timing: zooming in shows single edges and pulses.
  check('both mirrors are drawn', (await page.locator('#timing path.mirror').count()) === 2);
  await page.getByRole('button', { name: 'Show the first pulses' }).click();
  check('A and B are drawn', (await page.locator('#timing path.pin').count()) === 2);
  check('single pulses are drawn', (await page.locator('#timing line.pulse').count()) > 0);
  // The workpiece.
  if (said.view_3d) {
    await page.locator('#view3d').scrollIntoViewIfNeeded();
    await page.waitForSelector('#view3d canvas', waiting);
    check('the 3-D view is not blank', (await colours(page, '#view3d canvas')) > 20);
    const front = await picture(page, '#view3d canvas');
    await page.locator('#view3d canvas').focus();
    await page.keyboard.press('ArrowRight');
    check('the 3-D view turns', (await picture(page, '#view3d canvas')) !== front);
  } else {
    check('a build without the 3-D view says so', (await page.textContent('#no-3d')).includes('no 3-D view'));
  }
  check('the relief is in um', data.relief.unit === 'um' && data.relief.deepest > 0);
  // Every control has a name, and nothing is wider than the screen.
  const nameless = await page.evaluate(() => [...document.querySelectorAll('button, input, select, canvas')].filter((node) => !(node.getAttribute('aria-label') || node.textContent.trim() || (node.labels && node.labels.length))).length);
  check(`${nameless} controls have no name`, nameless === 0);
  const wider = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  check(`the page is ${wider} pixels wider than the screen`, wider <= 0);
  await page.screenshot({ path: join(shots, `${shot}.png`), fullPage: true });
  assert.deepEqual(troubles, [], 'the page complained');
  checks += 1;
  await page.close();
}

async function badPage(context, shot) {
  const { page, troubles } = await open(context, 'bad.html');
  const data = await page.evaluate(() => gravure.data);
  const verdict = await page.textContent('#verdict');
  check('the verdict is not good', verdict.includes('Not within limits') && data.verdict.violations.length > 0);
  check('each violation is said once', (await page.locator('#verdict ol > li').count()) === data.verdict.violations.length);
  check('the title is text', (await page.textContent('h1')) === data.job.title && data.job.title.includes('<img'));
  check('nothing of it became markup', (await page.locator('img').count()) === 0 && (await page.locator('h1 b').count()) === 0);
  await page.screenshot({ path: join(shots, `${shot}.png`), fullPage: true });
  assert.deepEqual(troubles, [], 'the page complained');
  checks += 1;
  await page.close();
}

/** What a build without Node writes: the same page with nothing in the script of the 3-D view. */
async function plainPage(context, shot) {
  const parts = readFileSync(join(folder, 'good.html'), 'utf8').split('<script>');
  check('the bundle stands in a script of its own', parts.length === 3);
  parts[1] = '\n</script>\n';
  writeFileSync(join(folder, 'plain.html'), parts.join('<script>'));
  const { page, troubles } = await open(context, 'plain.html');
  check('a build without the 3-D view says so', (await page.textContent('#no-3d')).includes('no 3-D view'));
  check('everything else is there', (await colours(page, '#layers-canvas')) > 2 && (await page.locator('#seam path.seam').count()) === 1 && (await page.locator('#sources-table tbody tr').count()) > 0);
  await page.screenshot({ path: join(shots, `${shot}.png`), fullPage: true });
  assert.deepEqual(troubles, [], 'the page complained');
  checks += 1;
  await page.close();
}

/** A program that follows a path, with a landing beyond its limit. */
async function pathPage(context, shot) {
  const { page, troubles } = await open(context, 'path.html', false);
  const data = await page.evaluate(() => gravure.data);
  check('the path is not within limits', (await page.textContent('#verdict')).includes('Not within limits'));
  check('its violation is said once', (await page.locator('#verdict ol > li').count()) === 1 && data.verdict.violations.length === 1);
  check('its title is text', (await page.textContent('h1')) === '<b>path</b>');
  check('every figure has its bar, one of them beyond the limit', (await page.locator('#figure-bars .track').count()) === data.figures.length && (await page.locator('#figure-bars .over').count()) === 1);
  check('the pulses are on the surface', (await colours(page, '#map-canvas')) > 2);
  const pulses = await picture(page, '#map-canvas');
  await page.selectOption('#map-what', 'heights');
  check('the surface is shown instead', (await picture(page, '#map-canvas')) !== pulses);
  check('seven axes are drawn over time', (await page.locator('#traces path.band').count()) === 7 && (await page.locator('#axis-table tbody tr').count()) === 7);
  check('the pulses stand on the workpiece', (await colours(page, '#view3d canvas')) > 3);
  const turned = await picture(page, '#view3d canvas');
  await page.locator('#view3d canvas').focus();
  await page.keyboard.press('ArrowRight');
  check('the workpiece of the path turns', (await picture(page, '#view3d canvas')) !== turned);
  await page.selectOption('#points-what', 'height');
  check('how many pulses are shown is told', (await page.textContent('#workpiece-lead')).includes(`All ${data.sample.shown.toLocaleString('en-US').replaceAll(',', '\u202f')}`) || data.sample.every > 1);
  check('the clocks lead from the seed to the job', (await page.locator('#clock-tree .node').count()) === 5);
  check('one servo period is drawn, without A and B', (await page.locator('#timing path.mirror').count()) === 2 && (await page.locator('#timing .gate').count()) > 0 && (await page.locator('#timing path.pin').count()) === 0);
  check('what does not apply is said', (await page.locator('#absent li').count()) > 3);
  const wider = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  check(`the page of the path is ${wider} pixels wider than the screen`, wider <= 0);
  await page.screenshot({ path: join(shots, `${shot}.png`), fullPage: true });
  assert.deepEqual(troubles, [], 'the page complained');
  checks += 1;
  await page.close();
}

/** A part marked zone by zone, within limits: nothing on its page is red. */
async function zonesPage(context, shot) {
  const { page, troubles } = await open(context, 'zones.html', false);
  const data = await page.evaluate(() => gravure.data);
  check('zones are within limits', (await page.textContent('#verdict')).includes('Within limits'));
  check('an axis beyond its limit by no more than rounding is not red', data.axes.some((axis) => axis.jerk[0] > axis.jerk[1]) && (await page.locator('#axis-table .over').count()) === 0);
  check('the job is told as zones', (await page.textContent('#job')).includes('one zone after the other') && (await page.textContent('#job')).includes('Contours'));
  check('the pulses are on the part', (await colours(page, '#map-canvas')) > 1);
  const [stage, canvas] = await Promise.all(['#map-view .stage', '#map-canvas'].map(async (part) => (await page.locator(part).boundingBox()).width));
  check('the picture fills its frame', stage - canvas <= 2);
  await page.screenshot({ path: join(shots, `${shot}.png`), fullPage: true });
  assert.deepEqual(troubles, [], 'the page complained');
  checks += 1;
  await page.close();
}

let browser;
try {
  for (const [name, viewport, colorScheme] of [['wide', { width: 1280, height: 800 }, 'light'], ['phone', { width: 390, height: 844 }, 'dark']]) {
    browser = await chromium.launchPersistentContext(join(profile, name), { executablePath, headless: true, args, viewport, colorScheme });
    await goodPage(browser, `good_${name}`);
    await badPage(browser, `bad_${name}`);
    await pathPage(browser, `path_${name}`);
    await zonesPage(browser, `zones_${name}`);
    if (name === 'wide') {
      await plainPage(browser, 'plain_wide');
      const { page } = await open(browser, 'good.html');
      await page.pdf({ path: join(shots, 'good.pdf'), format: 'A4', printBackground: true });
      await page.close();
    }
    await browser.close();
    browser = undefined;
  }
  console.log(`${checks} checks passed; screenshots in ${shots}`);
} finally {
  if (browser) await browser.close();
  rmSync(profile, { recursive: true, force: true });
}
