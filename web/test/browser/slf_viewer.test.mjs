// SPDX-License-Identifier: Apache-2.0
// <slf-viewer>: several on a page, lazily; gestures that leave the page its scrolling; views in addresses; policies.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { FAR, elementPages, skip, state, viewOf, viewer } from './element_support.mjs';
import { newPage, settled, web } from './support.mjs';
import { viewerUnderTest } from './viewer_support.mjs';

const here = viewerUnderTest();
const pageOf = elementPages(here);
const axe = join(web, 'node_modules/axe-core/axe.min.js');

test('two viewers have their own view and state, one far away waits, and events tell', { skip }, async () => {
  const page = await pageOf('two', viewer('a', 'azimuth="10"') + viewer('b', 'src="/files/none.slf" background="black"') + FAR + viewer('c'));
  await page.evaluate(() => {
    window.told = [];
    for (const each of document.querySelectorAll('slf-viewer'))
      for (const type of ['ready', 'error']) each.addEventListener(type, (e) => window.told.push(`${each.id} ${type} ${e.detail.kind ?? ''}`.trim()));
  });
  assert.equal(await state(page, 'a'), 'ready');
  await page.evaluate(() => document.getElementById('b').setAttribute('src', '/files/none.slf'));
  assert.equal(await state(page, 'b', /^failed/), 'failed network');
  assert.equal((await viewOf(page)).azimuth, '10');
  assert.equal(await page.evaluate(() => document.getElementById('c').state), 'idle');
  await page.evaluate(() => document.getElementById('c').scrollIntoView());
  assert.equal(await state(page, 'c'), 'ready');
  const told = await page.evaluate(() => window.told);
  assert.ok(told.includes('a ready') && told.includes('b error network') && told.includes('c ready'), told.join());
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('methods turn, fit, take a picture and open another file; taken out, a viewer ends the worker of what is on its way', { skip }, async () => {
  const page = await pageOf('methods', viewer('a'));
  await state(page, 'a');
  const said = await page.evaluate(async () => {
    const a = document.getElementById('a'), views = [];
    a.view = { azimuth: 50, zoom: 2 };
    views.push(a.view);
    a.fit();
    views.push(a.view);
    const picture = await a.picture();
    await a.open(await (await fetch('/files/can.slf')).blob(), 'own.slf');
    return { views, type: picture.type, state: a.state };
  });
  assert.deepEqual([said.views[0].azimuth, said.views[0].zoom, said.views[1].zoom, said.type, said.state], ['50', '2', '1', 'image/png', 'ready']);
  await page.evaluate(() => void document.getElementById('a').open('/files/silent.slf'));
  for (let i = 0; i < 50 && page.workers().length === 0; ++i) await page.waitForTimeout(100);
  assert.equal(page.workers().length, 1);
  await page.evaluate(() => document.getElementById('a').remove());
  for (let i = 0; i < 50 && page.workers().length > 0; ++i) await page.waitForTimeout(100);
  assert.equal(page.workers().length, 0);
  await page.close();
});

test('of twelve viewers eight are awake, and those that sleep keep their picture', { skip }, async () => {
  const page = await pageOf('many', Array.from({ length: 12 }, (_, i) => viewer(`v${i}`, 'levels="4"') + '<div style="height: 600px"></div>').join(''));
  for (let i = 0; i < 12; ++i) {
    await page.evaluate((id) => document.getElementById(id).scrollIntoView(), `v${i}`);
    assert.equal(await state(page, `v${i}`), 'ready');
  }
  await page.waitForFunction(() => [...document.querySelectorAll('slf-viewer')].filter((each) => each.viewer).length <= 8);
  const still = await page.evaluate(() => document.getElementById('v0').shadowRoot.getElementById('poster').src);
  assert.match(still, /^blob:/);
  await page.evaluate(() => document.getElementById('v0').scrollIntoView());
  assert.equal(await state(page, 'v0'), 'ready');
  await page.click('#v0 [data-do=spin]');
  assert.equal(await page.getAttribute('#v0 [data-do=spin]', 'aria-pressed'), 'true'); // once: nothing listens from before
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('twelve that are seen at once all show their picture, and a click wakes one that sleeps', { skip }, async () => {
  const style = 'levels="4" embed style="height: 90px; width: 90px; display: inline-block; margin: 2px"';
  const page = await pageOf('grid', Array.from({ length: 12 }, (_, i) => viewer(`v${i}`, style)).join(''));
  const shows = () => [...document.querySelectorAll('slf-viewer')].every((each) =>
    each.state === 'ready' || each.shadowRoot.getElementById('poster').src.startsWith('blob:'));
  await page.waitForFunction(shows);
  const asleep = await page.evaluate(() => [...document.querySelectorAll('slf-viewer')].filter((each) => !each.viewer).map((each) => each.id));
  assert.equal(asleep.length, 4);
  assert.ok(await page.isHidden(`#${asleep[0]} #tools`));
  await page.click(`#${asleep[0]}`);
  assert.equal(await state(page, asleep[0]), 'ready');
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('a poster that does not arrive leaves no sign of a broken picture', { skip }, async () => {
  const page = await pageOf('poster', FAR + viewer('a', 'poster="/files/none.png"'));
  await page.waitForFunction(() => document.getElementById('a').shadowRoot.getElementById('poster').hidden);
  assert.equal(await page.evaluate(() => document.getElementById('a').viewer), null); // it sleeps still
  await page.close();
});

test('an embedded page lets the page around it scroll', { skip }, async () => {
  const page = await pageOf('around', `<iframe src="${here.server.page}?src=/files/can.slf&embed" title="A can" width="300" height="300"></iframe>${FAR}`);
  const frame = await (await page.waitForSelector('iframe')).contentFrame();
  await frame.waitForFunction(() => document.body.dataset.state === 'ready');
  await page.mouse.move(150, 250);
  await page.mouse.wheel(0, 120);
  await page.waitForFunction(() => scrollY > 0);
  await page.close();
});

test('the wheel and one finger scroll the page until somebody takes hold; two fingers turn', { skip }, async () => {
  const page = await pageOf('polite', viewer('a') + FAR, { hasTouch: true });
  await state(page, 'a');
  const scrolled = () => page.evaluate(() => scrollY);
  const top = async () => {
    do {
      await page.evaluate(() => scrollTo(0, 0));
      await page.waitForTimeout(150); // a swipe glides on after its end
    } while ((await scrolled()) !== 0);
  };
  const session = await page.context().newCDPSession(page);
  const fingers = (type, points) => session.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  const swipe = async () => {
    await fingers('touchStart', [[200, 280]]);
    for (let i = 1; i < 10; ++i) await fingers('touchMove', [[200 + 3 * i, 280 - 12 * i]]);
    await fingers('touchEnd', []);
    await page.waitForTimeout(300);
  };
  const before = await viewOf(page);
  await swipe();
  assert.ok((await scrolled()) > 20, 'one finger scrolls');
  assert.deepEqual(await viewOf(page), before);
  await top();
  await fingers('touchStart', [[150, 200]]);
  await fingers('touchStart', [[150, 200], [250, 200]]);
  for (let i = 1; i <= 5; ++i) await fingers('touchMove', [[150 + 8 * i, 200], [250 + 8 * i, 200]]);
  await fingers('touchEnd', []);
  const turned = await viewOf(page);
  assert.notEqual(turned.azimuth, before.azimuth, 'two fingers turn');
  assert.equal(await scrolled(), 0);
  await page.touchscreen.tap(200, 200);
  await swipe();
  assert.equal(await scrolled(), 0, 'held, one finger turns');
  assert.notDeepEqual(await viewOf(page), turned);
  await page.touchscreen.tap(300, 60); // the heading: it lets go
  await page.mouse.move(200, 250);
  const { zoom } = await viewOf(page);
  await page.mouse.wheel(0, 50);
  await page.waitForFunction(() => scrollY > 0);
  assert.equal((await viewOf(page)).zoom, zoom);
  await top();
  await page.mouse.click(200, 250);
  await page.mouse.wheel(0, 50);
  await page.waitForFunction((was) => document.getElementById('a').view.zoom !== was, zoom);
  assert.equal(await scrolled(), 0);
  await page.close();
});

test('a link leads to the view: of the page by its parameters, of a viewer by its fragment', { skip }, async () => {
  const page = await here.opened('src=/files/can.slf&azimuth=12');
  const link = await page.evaluate(async () => {
    const { controls, page: elements } = window.viewer;
    controls.turn(30, 10);
    controls.zoom(0.5);
    controls.pan(20, 10);
    elements.one('[data-do=link]').click();
    await new Promise((done) => setTimeout(done, 50));
    return { address: elements.at('address').value, pose: controls.pose };
  });
  await page.goto(link.address);
  await settled(page);
  const pose = await page.evaluate(() => window.viewer.controls.pose);
  for (const name of ['azimuth', 'elevation', 'distance', 'fov']) assert.ok(Math.abs(pose[name] / link.pose[name] - 1) < 1e-4, name);
  await page.evaluate(() => window.viewer.page.one('[data-do=snippet]').click());
  assert.match(await page.evaluate(() => window.viewer.page.at('address').value), /^<iframe src="http[^"]*&#38;embed=1"/);
  await page.close();
  const own = await pageOf('link', FAR + viewer('a'));
  await own.goto(`${own.address}#a?azimuth=77&zoom=3`);
  await own.reload();
  await state(own, 'a');
  assert.deepEqual(((view) => [view.azimuth, view.zoom])(await viewOf(own)), ['77', '3']);
  await own.close();
});

test('its language is that of the element, of the page around it, or of the reader', { skip }, async () => {
  const page = await pageOf('tongues', `<div lang="fr">${viewer('a')}</div>${viewer('b', 'lang="ja"')}${viewer('c')}`, { locale: 'es-ES' });
  const said = [];
  for (const id of ['a', 'b', 'c']) {
    await state(page, id);
    said.push(await page.evaluate((name) => document.getElementById(name).shadowRoot.querySelector('[data-do=help]').title, id));
  }
  assert.deepEqual(said, ['Aide (H)', 'ヘルプ (H)', 'Help (H)']); // <html lang="en"> is around the third
  await page.close();
});

test('without a choice it is dark where the page is, and follows it', { skip }, async () => {
  const page = await pageOf('dark', viewer('a') + viewer('b', 'style="color-scheme: dark"') + viewer('c', 'background="white"'));
  for (const id of ['a', 'b', 'c']) await state(page, id);
  const shown = () => page.evaluate(() => ['a', 'b', 'c'].map((id) => document.getElementById(id).viewer.background));
  assert.deepEqual(await shown(), ['paper', 'slate', 'white']);
  await page.emulateMedia({ colorScheme: 'dark' });
  await page.waitForFunction(() => document.getElementById('a').viewer.background === 'slate');
  assert.deepEqual(await shown(), ['slate', 'slate', 'white']);
  await page.evaluate(() => document.documentElement.setAttribute('style', 'color-scheme: light'));
  await page.waitForFunction(() => document.getElementById('a').viewer.background === 'paper');
  await page.close();
});

test('axe finds nothing on the page, in its settings, and in viewers of a page', { skip }, async (t) => {
  if (!existsSync(axe)) return t.skip('skipped: there is no axe-core (npm ci in web/)');
  const findings = async (page) => {
    await page.evaluate(readFileSync(axe, 'utf8'));
    const { violations } = await page.evaluate(() => window.axe.run());
    return violations.map(({ id, nodes }) => `${id}: ${nodes.map((n) => n.html.slice(0, 80)).join(' | ')}`);
  };
  const page = await here.opened();
  assert.deepEqual(await findings(page), []);
  await page.click('[data-do=panel]');
  assert.deepEqual(await findings(page), []);
  await page.close();
  const own = await pageOf('axe', viewer('a') + viewer('b', 'background="slate"'));
  for (const id of ['a', 'b']) await state(own, id);
  assert.deepEqual(await findings(own), []);
  await own.close();
});

test("a page's policy without unsafe-eval and unsafe-inline is enough; without wasm-unsafe-eval it is said", { skip }, async () => {
  const strict = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; " +
    "img-src 'self' blob: data:; connect-src 'self'; worker-src 'self'";
  for (const [policy, end] of [[strict, 'ready'], [strict.replace("'wasm-unsafe-eval'", ''), 'failed policy']]) {
    const page = await newPage(here.chrome), said = [];
    await page.route(/\.html/, async (route) => {
      const response = await route.fetch();
      await route.fulfill({ response, headers: { ...response.headers(), 'content-security-policy': policy } });
    });
    page.on('console', (message) => /Content Security Policy|violates/i.test(message.text()) && said.push(message.text()));
    await page.goto(`${here.server.page}?src=/files/can.slf`);
    assert.equal(await settled(page), end);
    if (end === 'ready') {
      await page.click('[data-do=panel]');
      assert.deepEqual(said, []);
    } else assert.match(await page.textContent('#problem'), /wasm-unsafe-eval/);
    await page.close();
  }
});

test('where made/ is missing a viewer says so, in its language, beside what its page has written into it', { skip }, async () => {
  const name = 'missing', body = '<slf-viewer id="a" src="/files/can.slf" lang="fr" loading="click"><p>A can.</p></slf-viewer><div id="later"></div>';
  await (await pageOf(name, body)).close();
  const page = await newPage(here.chrome);
  await page.route('**/made/**', (route) => route.fulfill({ status: 404, body: '' }));
  await page.goto(`${here.server.url}/files/pages/${name}.html`);
  await page.waitForFunction(() => document.getElementById('a').state === 'failed network');
  await page.waitForFunction(() => document.getElementById('a').shadowRoot.querySelector('[role=alert]'));
  const said = await page.evaluate(async () => {
    const a = document.getElementById('a'), card = a.shadowRoot.querySelector('[role=alert]'), later = document.createElement('slf-viewer');
    const kinds = [];
    later.addEventListener('error', ({ detail }) => kinds.push(detail.kind, detail.detail));
    document.getElementById('later').append(later);
    await later.open('/files/can.slf');
    return { lang: card.lang, text: card.innerText, own: a.innerText, height: a.getBoundingClientRect().height, kinds, viewer: later.viewer };
  });
  assert.match(said.text, /^Quelque chose n’est pas arrivé\s+made\/viewer_markup\.js$/);
  assert.deepEqual([said.lang, said.own, said.height], ['fr', 'A can.', 300]);
  assert.deepEqual([said.kinds, said.viewer], [['network', 'made/viewer_markup.js'], null]);
  assert.deepEqual(page.wrong, []);
  await page.screenshot({ path: join(here.can.dir, 'missing.png') });
  await page.close();
});
