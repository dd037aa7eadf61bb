// Compares what payload.mjs computed with the package's version, tests/hashes.txt and tests/worlds.txt.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";

const read = (path) => readFileSync(new URL(path, import.meta.url), "utf8");

// name -> hash, as in tests/hashes.txt: lines `name hash`, comments after `#`.
const listed = (path) =>
  Object.fromEntries(
    read(path)
      .split("\n")
      .map((line) => line.replace(/#.*/, "").trim())
      .filter(Boolean)
      .map((line) => line.split(/\s+/)),
  );
const hashes = { ...listed("../hashes.txt"), ...listed("../worlds.txt") };

// name -> text of the scenes that the hashes belong to: `NAME.scn`, or `NAME.json` by a method as `NAME/METHOD`.
export const scenes = Object.fromEntries(
  Object.keys(hashes).map((name) => {
    const [scene, integrator] = name.split("/");
    if (!integrator) return [name, read(`../../scenes/${scene}.scn`)];
    const world = JSON.parse(read(`../../scenes/${scene}.json`));
    return [name, JSON.stringify({ ...world, run: { ...world.run, integrator } })];
  }),
);

// name -> corners and triangles of the OFF meshes that those scenes name.
export const meshes = Object.fromEntries(
  [...new Set(Object.values(scenes).flatMap((text) => text.match(/assets\/\w+\.off/g) ?? []))].map((name) => {
    const [corners, faces, , ...numbers] = read(`../../scenes/${name}`).replace("OFF", "").replace(/#.*/g, "").trim().split(/\s+/).map(Number);
    const triangles = numbers.slice(3 * corners);
    assert.equal(triangles.length, 4 * faces, `${name}: triangles alone`);
    return [name, { corners: numbers.slice(0, 3 * corners), triangles: triangles.filter((_, i) => i % 4 > 0) }];
  }),
);

export function check(result) {
  assert.equal(result.version, JSON.parse(read("../../target/npm/package.json")).version);
  assert.deepEqual(result.hashes, hashes);

  const { fountain } = result;
  // 50 a second that live 1 s.
  assert.ok(Math.abs(fountain.count - 50) <= 1, `${fountain.count} alive`);
  assert.equal(fountain.capacity, 100);
  assert.ok(Math.abs(fountain.time - 302 / 60) < 1e-6);
  for (const [what, each] of [["length", 3], ["speeds", 3]]) {
    assert.equal(fountain[what], each * fountain.capacity, what);
  }
  for (const [what, each] of [["colors", 4], ["ids", 1]]) {
    assert.equal(fountain[what], each * fountain.count, what);
  }
  assert.ok(fountain.sameMemory && fountain.finite);
  const { born, died, refused } = fountain.report;
  assert.equal(born, fountain.count + died.lifetime);
  assert.equal(refused, 0);

  assert.deepEqual(result.balls.radii, [0.25, 0.5, 0]);
  assert.deepEqual(result.balls.speeds, [0, 0, 0, 1, 0, 0, 0, 0, 0]);
  assert.equal(result.balls.report.contacts, 1);

  assert.equal(result.error, "scene:2:5: particle: expected the velocity, a number, found 'x'");
  assert.equal(result.missing, "scene:1:1: mesh: there is no mesh file 'bunny.off'");
}
