// The npm package in headless Chromium: CHROMIUM, or /usr/bin/chromium.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { mkdtempSync, rmSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { extname, join, normalize } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

import { check, meshes, scenes } from "./expected.mjs";

const here = fileURLToPath(new URL(".", import.meta.url));
// URL prefix -> folder.
const folders = { "/npm/": join(here, "../../target/npm"), "/tests/": here };
const types = { ".html": "text/html", ".js": "text/javascript", ".mjs": "text/javascript", ".wasm": "application/wasm" };

const server = createServer(async (request, response) => {
  const path = normalize(decodeURIComponent(new URL(request.url, "http://localhost").pathname));
  if (path === "/") {
    response.setHeader("content-type", "text/html");
    response.end('<!doctype html><title>pointmass</title><link rel="icon" href="data:,">');
    return;
  }
  const prefix = Object.keys(folders).find((prefix) => path.startsWith(prefix));
  try {
    const body = await readFile(join(folders[prefix], path.slice(prefix.length)));
    response.setHeader("content-type", types[extname(path)] ?? "application/octet-stream");
    response.end(body);
  } catch {
    response.statusCode = 404;
    response.end();
  }
});

const profile = mkdtempSync(join(tmpdir(), "pointmass-chromium-"));
let browser;
let origin;

before(async () => {
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  origin = `http://127.0.0.1:${server.address().port}`;
  browser = await chromium.launchPersistentContext(profile, {
    executablePath: process.env.CHROMIUM || "/usr/bin/chromium",
    headless: true,
    args: [
      "--no-sandbox", // containers run tests as root
      "--disable-gpu",
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
    ],
  });
});

after(async () => {
  await browser?.close();
  server.close();
  rmSync(profile, { recursive: true, force: true });
});

// A blank page of the server's origin; anything it complains about ends up in `errors`.
async function open() {
  const page = await browser.newPage();
  const errors = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  await page.goto(origin);
  return { page, errors };
}

test("computes what every other engine computes", async () => {
  const { page, errors } = await open();
  const result = await page.evaluate(async ([scenes, meshes]) => {
    const pointmass = await import("/npm/pointmass.js");
    await pointmass.default();
    const { run } = await import("/tests/payload.mjs");
    return run(pointmass, scenes, meshes);
  }, [scenes, meshes]);
  check(result);
  assert.deepEqual(errors, []);
  await page.close();
});
