// Opens comparison pages in a browser and uses them as a person would.
//
// Usage: node page.mjs BROWSER compare.json PAGE.html... [--screenshots DIR]
// Prints a JSON object: for every page the list of what is wrong with it.

import { readFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const words = process.argv.slice(2);
const flag = words.indexOf("--screenshots");
const screenshots = flag < 0 ? null : words.splice(flag, 2)[1];
const [executablePath, jsonPath, ...pages] = words;
const record = JSON.parse(readFileSync(jsonPath, "utf8"));

const browser = await chromium.launch({ executablePath, args: ["--no-sandbox"] });
const problems = {};
for (const path of pages) {
  problems[path] = await examine(path);
}
await browser.close();
console.log(JSON.stringify(problems));

async function examine(path) {
  const wrong = [];
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
  page.setDefaultTimeout(3000);
  page.on("console", (message) => message.type() === "error" && wrong.push("console: " + message.text()));
  page.on("pageerror", (error) => wrong.push("script: " + error.message));
  page.on("request", (request) => {
    const { protocol } = new URL(request.url());
    if (!["file:", "data:"].includes(protocol)) wrong.push("request: " + request.url());
  });
  await page.goto(pathToFileURL(path).href);
  for (const check of [images, table, slider, choices, keyboard, themes, phone]) {
    try {
      await check(page, (problem) => wrong.push(`${check.name}: ${problem}`));
    } catch (error) {
      wrong.push(`${check.name}: ${error.message.split("\n")[0]}`);
    }
  }
  await page.close();
  return wrong;
}

async function images(page, fault) {
  const found = await page.$$eval(".gallery img", (all) =>
    all.map((i) => ({ id: i.id, alt: i.alt, size: [i.naturalWidth, i.naturalHeight] })));
  const drawn = record.methods.filter((m) => m.result), wrong = drawn.filter((m) => m.result.wrong_pixels > 0);
  const expected = 1 + drawn.length + wrong.length;
  if (found.length !== expected) fault(`${found.length} pictures instead of ${expected}`);
  for (const { id, alt, size } of found) {
    if (String(size) !== String(record.size)) fault(`${id} is ${size}`);
    if (!alt) fault(`${id} has no alternative text`);
  }
}

async function table(page, fault) {
  const rows = await page.locator("tbody tr").count();
  if (rows !== record.methods.length) fault(`${rows} rows of ${record.methods.length} methods`);
  for (const { method, title, why, unavailable, result } of record.methods) {
    const row = page.locator("#row-" + method);
    if ((await row.count()) !== 1) {
      fault(`no row of ${method}`);
      continue;
    }
    const text = await row.textContent();
    for (const part of [title, why, unavailable ?? ""]) {
      if (!text.includes(part)) fault(`the row of ${method} lacks "${part}"`);
    }
    if (!result) continue;
    const cells = await row.locator("td[data-label]").allTextContents();
    const { wrong_pixels, triangles, vertices, fragments, passes, planning_ms, render_ms } = result;
    const expected = [wrong_pixels, triangles, vertices, fragments, passes].map(String);
    const shown = cells.map((cell) => cell.replace(/\u202f/g, ""));
    if (String(shown.slice(0, 5)) !== String(expected)) fault(`the row of ${method} says ${shown}, not ${expected}`);
    if (Math.abs(shown[5] - planning_ms - render_ms) > 0.06) fault(`the time of ${method} is ${shown[5]}`);
  }
}

function look(page) {
  return page.locator("#slider").screenshot({ animations: "disabled" });
}

async function slider(page, fault) {
  const box = await page.locator("#slider").boundingBox();
  const drag = async (from, to) => {
    await page.mouse.move(box.x + from * box.width, box.y + 0.3 * box.height);
    await page.mouse.down();
    await page.mouse.move(box.x + to * box.width, box.y + 0.3 * box.height, { steps: 4 });
    await page.mouse.up();
    const at = Number(await page.locator("#at").inputValue()) / 1000;
    if (Math.abs(at - to) > 0.02) fault(`dragged to ${to}, and it is at ${at}`);
    return look(page);
  };
  const [left, right] = [await drag(0.5, 0.2), await drag(0.2, 0.8)];
  if (left.equals(right)) fault("moving the divider changes nothing");
  if (!(await drag(0.8, 0.2)).equals(left)) fault("moving it back does not bring the picture back");
}

async function choices(page, fault) {
  const named = await page.$$eval("#right option", (all) => all.map((option) => option.value));
  const pictures = await page.$$eval(".gallery img", (all) => all.map((image) => image.id));
  if (String(named) !== String(pictures)) fault("the choices are not the pictures");
  const before = await look(page);
  for (const [side, image] of [["left", "over"], ["right", "under"]]) {
    for (const id of [named.at(-1), named[0]]) {
      await page.selectOption("#" + side, id);
      const same = await page.evaluate(([a, b]) => document.getElementById(a).src === document.getElementById(b).src,
        [image, id]);
      if (!same) fault(`choosing ${id} on the ${side} does not show it`);
    }
  }
  if ((await look(page)).equals(before)) fault("choosing other pictures changes nothing");
  for (const { method, result } of record.methods.filter((m) => m.result)) {
    const kind = result.wrong_pixels > 0 ? "difference" : "picture";
    await page.locator(`#row-${method} button`).click();
    const chosen = [await page.inputValue("#left"), await page.inputValue("#right")];
    if (String(chosen) !== `picture-truth,${kind}-${method}`) fault(`the row of ${method} shows ${chosen}`);
  }
}

async function keyboard(page, fault) {
  await page.locator("#left").focus();
  await page.keyboard.press("Tab");
  await page.keyboard.press("Tab");
  if ((await page.evaluate(() => document.activeElement.id)) !== "at") return fault("Tab does not lead to the divider");
  await page.keyboard.press("Home");
  const first = await look(page);
  for (let i = 0; i < 20; i++) await page.keyboard.press("ArrowRight");
  if ((await page.inputValue("#at")) !== "100") fault("20 arrows lead to " + (await page.inputValue("#at")));
  await page.keyboard.press("End");
  if ((await look(page)).equals(first)) fault("keys change nothing");
}

async function themes(page, fault) {
  const paper = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const found = {};
  for (const colorScheme of ["light", "dark"]) {
    await page.emulateMedia({ colorScheme });
    found[colorScheme] = await paper();
    await photograph(page, `${colorScheme}-wide`);
  }
  if (found.light === found.dark) fault("light and dark are the same");
}

async function phone(page, fault) {
  for (const width of [360, 700]) {
    await page.setViewportSize({ width, height: 740 });
    const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    if (overflow > 0) fault(`at ${width} pixels it is ${overflow} too wide`);
  }
  await page.setViewportSize({ width: 390, height: 844 });
  await photograph(page, "dark-narrow");
  await page.emulateMedia({ colorScheme: "light" });
  await photograph(page, "light-narrow");
}

async function photograph(page, name) {
  if (screenshots) await page.screenshot({ path: join(screenshots, name + ".png"), fullPage: true });
}
