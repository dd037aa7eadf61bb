// The npm package in Node, as it would be published: packed, unpacked, found by its name.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";

import { check, meshes, scenes } from "./expected.mjs";
import { run } from "./payload.mjs";

const built = fileURLToPath(new URL("../../target/npm", import.meta.url));
let project;
let pointmass;

before(async () => {
  project = mkdtempSync(join(tmpdir(), "pointmass-"));
  const installed = join(project, "node_modules", "pointmass");
  mkdirSync(installed, { recursive: true });
  const packed = execFileSync("npm", ["pack", "--json", "--pack-destination", project], { cwd: built });
  const [{ filename }] = JSON.parse(packed);
  execFileSync("tar", ["-xzf", join(project, filename), "-C", installed, "--strip-components=1"]);
  const entry = createRequire(join(project, "main.js")).resolve("pointmass");
  pointmass = await import(pathToFileURL(entry));
});

after(() => rmSync(project, { recursive: true, force: true }));

test("is ready as soon as it is imported", () => check(run(pointmass, scenes, meshes)));

test("init() is allowed, as browsers need it", async () => {
  await pointmass.default();
  check(run(pointmass, scenes, meshes));
});

test("declares the types of what it exports", () => {
  const types = readFileSync(join(built, "pointmass.d.ts"), "utf8");
  assert.match(types, /export function version\(\): string;/);
  assert.match(types, /positions\(\): Float32Array;/);
  assert.match(types, /radii\(\): Float32Array;/);
});

test("says for whom it is", () => {
  const { engines, repository, keywords, files } = JSON.parse(readFileSync(join(built, "package.json"), "utf8"));
  assert.deepEqual([engines.node, repository.type, keywords.includes("particles")], [">=20", "git", true]);
  assert.ok(files.includes("README.md"));
  for (const readme of [join(built, "README.md"), join(built, "../../README.md")]) {
    assert.match(readFileSync(readme, "utf8"), /Chrome 96, Firefox 89, Safari 16\.4, Node 20/);
  }
});
