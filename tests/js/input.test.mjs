// Whatever the package is given, it works or throws an Error with a sentence, and the next world computes what it should.
import assert from "node:assert/strict";
import { afterEach, test } from "node:test";
import init, { Files, World } from "../../target/npm/node.js";

const scene = {
  run: { capacity: 100, integrator: "verlet" },
  forces: [{ gravity: { acceleration: [0, -9.8, 0] } }],
  emitters: [{ shape: { circle: { center: [0, 0, 0], normal: [0, 1, 0], radius: 0.1 } }, rate: 50, speed: 5, lifetime: 1 }],
};
const { memory } = await init();

// The hash after two seconds.
function hash(...args) {
  const world = new World(...args);
  for (let frame = 1; frame <= 120; frame++) world.stepTo(frame / 60);
  const result = world.hash();
  world.free();
  return result;
}
const expected = hash(JSON.stringify(scene));

afterEach(() => assert.equal(hash(JSON.stringify(scene)), expected, "the package still works"));

// A sentence, not the word of a trap.
function refuses(action, pattern) {
  assert.throws(action, (error) => {
    assert.ok(error instanceof Error && !(error instanceof WebAssembly.RuntimeError), String(error));
    assert.match(error.message, pattern);
    assert.ok(error.message.length < 400 && !error.message.includes("\n"), error.message);
    return true;
  });
}

test("a scene is an object or a text", () => {
  assert.equal(hash(scene), expected);
  assert.equal(hash(new String(JSON.stringify(scene)).toString()), expected);
  const circular = {};
  circular.self = circular;
  for (const other of [undefined, null, 7, NaN, true, 7n, [], [scene], Symbol("scene"), () => scene]) {
    refuses(() => new World(other), /a scene has to be an object, or its text/);
  }
  refuses(() => new World(circular), /the scene has no JSON/);
  refuses(() => new World({ run: { seed: 7n } }), /the scene has no JSON/);
  refuses(() => new World({ toJSON: () => undefined }), /a text has to be a string|no JSON/);
  refuses(() => new World({ toJSON() { throw 7; } }), /the scene has no JSON/);
  refuses(() => new World({ particles: 7 }), /^scene:1:\d+: /);
  refuses(() => new World({ particles: [{ position: [NaN, 0, 0] }] }), /^scene:1:\d+: /);
  refuses(() => new World("x".repeat(40 << 20)), /characters/);
  refuses(() => new World(`{"particles": [${"{},".repeat(4e6)}{}]}`), /not enough memory/);
});

test("a seed is a number or a BigInt", () => {
  for (const seed of [0, 7, 2 ** 31, 2 ** 32 + 1, Number.MAX_SAFE_INTEGER]) {
    assert.equal(hash(scene, null, null, seed), hash(scene, undefined, undefined, BigInt(seed)));
  }
  assert.notEqual(hash(scene, null, null, 1), hash(scene, null, null, 2));
  assert.match(hash(scene, null, null, 2n ** 64n - 1n), /^[0-9a-f]{16}$/);
  for (const seed of [-1, 0.5, NaN, Infinity, 2 ** 53, -1n, 2n ** 64n, "7", {}, true]) {
    refuses(() => new World(scene, null, null, seed), /^the seed has to be a whole number/);
  }
});

test("a capacity fits into memory or is refused, again and again", () => {
  const world = new World(scene, null, 1000);
  assert.equal(world.capacity, 1000);
  world.free();
  assert.equal(new World(scene, null, 0).count, 0);
  for (const capacity of [-1, NaN, Infinity, 0.5, 2 ** 32, 1e300, "7", 7n, {}]) {
    refuses(() => new World(scene, null, capacity), /^the capacity has to be a whole number/);
  }
  for (const capacity of [5e7, 1e9, 2 ** 32 - 1]) {
    refuses(() => new World(scene, null, capacity), /not enough memory for \d+ particles/);
    refuses(() => new World({ ...scene, run: { capacity } }), /not enough memory for \d+ particles/);
  }
  const grown = memory.buffer.byteLength;
  for (let i = 0; i < 20; i++) refuses(() => new World(scene, null, 5e7), /not enough memory/);
  assert.equal(memory.buffer.byteLength, grown, "nothing leaks");
});

test("fabrics fit into memory or are refused", () => {
  const fabric = (cells) => ({
    form: { sheet: { corner: [0, 0, 0], sides: [[1, 0, 0], [0, 0, 1]], cells } },
    mass: 1,
    springs: { structural: { ks: 10 }, shear: { ks: 1 }, bend: { ks: 1 } },
  });
  const world = new World({ cloths: [fabric([20, 20])] });
  assert.equal(world.count, 441);
  world.free();
  for (const cells of [[2047, 2046], [4e9, 4e9], [1, 4e6]]) {
    refuses(() => new World({ cloths: [fabric(cells)] }), /not enough memory|fewer cells/);
  }
});

test("a step is a finite number of seconds", () => {
  const world = new World(scene);
  for (const seconds of [Infinity, -Infinity, NaN, -1, undefined, "soon", {}]) {
    refuses(() => world.step(seconds), /^step has to be given a finite number of seconds/);
    refuses(() => world.stepTo(seconds), /^stepTo has to be given a finite number of seconds/);
  }
  refuses(() => world.step(1n), /BigInt/);
  assert.equal(world.time, 0);
  world.step(0);
  for (const seconds of [1e-9, 1e3, 1e9, 1e12, Number.MAX_VALUE]) world.step(seconds);
  assert.ok(world.count <= 100);
  world.restart();
  for (let frame = 1; frame <= 120; frame++) world.stepTo(frame / 60);
  assert.equal(world.hash(), expected);
  world.stepTo(1);
  assert.equal(world.time, 2, "not back");
  world.free();
  refuses(() => world.step(1), /null pointer/);
  refuses(() => world.positions(), /null pointer/);
});

test("files are given to as many worlds as one likes, each for what it is", () => {
  const files = new Files();
  files.addText("cube.off", "OFF\n0 0 0\n");
  files.addText("part.scn", "particle 1 2 3  0 0 0  1");
  files.addMesh("nozzle", new Float32Array([0, 0, 0, 0, 0, 1, 1, 0, 0]), new Uint32Array([0, 1, 2]));
  const emitter = (mesh) => ({ ...scene, emitters: [{ ...scene.emitters[0], shape: { mesh } }] });
  assert.equal(hash(emitter("nozzle"), files), hash(emitter("nozzle"), files));
  refuses(() => new World(emitter("cube.off"), files), /'cube.off' was added to the files as a text; a mesh is added by addMesh/);
  refuses(() => new World(emitter("none"), files), /no mesh 'none' was added/);
  refuses(() => new World("include nozzle", files), /nozzle/);
  refuses(() => files.addMesh("m", [0, 0, 0], [0]), /Float32Array/);
  refuses(() => files.addMesh("m", new Float32Array(4), new Uint32Array(3)), /threes/);
  refuses(() => files.addMesh("m", new Float32Array([0, NaN, 0]), new Uint32Array(3)), /m: /);
  refuses(() => files.addMesh("m", new Float32Array(9), new Uint32Array([0, 1, 3])), /m: /);
  refuses(() => files.addMesh("m", new Float32Array(9), new Uint32Array(3 << 24)), /a mesh may have/);
  refuses(() => files.addMesh(7, new Float32Array(9), new Uint32Array(3)), /name/);
  refuses(() => files.addText("t", 7), /string/);
  refuses(() => files.addText("t", "x".repeat(40 << 20)), /characters/);
  for (const other of [7, "files", {}, scene, new Map(), { clone: () => 7 }]) {
    refuses(() => new World(scene, other), /files have to be Files/);
  }
  files.free();
  refuses(() => new World(scene, files), /files have to be Files/);
});

test("columns of a user's own are views", () => {
  const warm = {
    particles: [{}, {}],
    custom: [{ name: "worn" }, { name: "heat", start: [80], newborn: 20 }],
    forces: [{ relaxation: { column: "heat", toward: 20, rate: 1.5 } }],
  };
  const world = new World(warm, null, 5);
  const heat = world.custom("heat");
  assert.deepEqual([heat.length, ...heat.subarray(0, 2), world.custom("worn")[1]], [5, 80, 20, 0]);
  for (let i = 1; i <= 60; i++) world.stepTo(i / 60);
  assert.ok(Math.abs(heat[0] - (20 + 60 * Math.exp(-1.5))) < 1e-3, `${heat[0]}`);
  refuses(() => world.custom("fuel"), /no column "fuel"/);
  refuses(() => world.custom(7), /string/);
  world.free();
});

test("views cover the capacity and outlive steps", () => {
  const world = new World(scene, null, 300);
  const [positions, velocities, radii] = [world.positions(), world.velocities(), world.radii()];
  assert.deepEqual([positions.length, velocities.length, radii.length], [900, 900, 300]);
  for (let frame = 1; frame <= 600; frame++) {
    world.stepTo(frame / 60);
    if (frame === 300) world.restart();
  }
  assert.equal(positions.length, 900, "not detached");
  assert.deepEqual([...positions.subarray(0, 3 * world.count)], [...world.positions().subarray(0, 3 * world.count)]);
  assert.ok(world.count > 40 && positions.subarray(0, 3 * world.count).some((x) => x !== 0));
  // Memory that grows detaches views; asked for anew they show the same.
  const seen = [...positions];
  const others = [];
  while (positions.length > 0) others.push(new World(scene, null, 100_000));
  assert.deepEqual([...world.positions()], seen);
  for (const other of others) other.free();
  world.free();
});

test("what there is to draw is in lists of numbers", () => {
  const world = new World({
    materials: [
      { size: 0.2, sprite: { picture: "puff", blend: "additive" }, trail: { seconds: 0.5, width: 0.1 } },
      { size: 2, shape: { form: { box: { min: [-1, -1, -1], max: [1, 1, 1] } } } },
    ],
    particles: [
      { position: [0, 0, 0], velocity: [3, 0, 0], material: 0, color: [255, 0, 51, 255] },
      { position: [0, 0, -4], velocity: [0, 1, 0], material: 0 },
      { position: [0, 5, 0], material: 1 },
      { position: [0, 7.2, 0] },
    ],
    springs: [{ ends: [2, 3], rest_length: 2, ks: 0, kd: 0 }],
  });
  for (let frame = 1; frame <= 60; frame++) world.stepTo(frame / 60);
  const near = (a, b) => assert.ok(a.length === b.length && a.every((x, i) => Math.abs(x - b[i]) < 1e-5), `${a} ${b}`);
  const sprites = world.sprites([3, 0, 9]);
  assert.equal(sprites.length, 2 * 16);
  near([...sprites.slice(0, 3)], [0, 1, -4]); // The farthest comes first.
  near([...sprites.slice(16)], [3, 0, 0, 0.1, 0, 0, 0, 0.1, 0, 1, 0, 0.2, 1, 0, 0, 2]);
  near([...world.shapes().slice(0, 12)], [0, 5, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1]);
  const dice = new World({ boxes: [{ sides: [0.2, 0.1, 0.4], mass: 1, position: [1, 2, 3], count: [2, 1, 1], spacing: [1, 0, 0] }] });
  assert.equal(dice.boxes().length, 2 * 17);
  near([...dice.boxes().slice(17, 29)], [2, 2, 3, 0.1, 0, 0, 0, 0.05, 0, 0, 0, 0.2]);
  assert.equal(dice.surfaces().length, 0);
  dice.free();
  const held = new World({
    boxes: [{ form: "octahedron", sides: [2, 2, 2], mass: 1, position: [0, 1, 0] }],
    cloths: [{ form: { sheet: { corner: [5, 0, 0], sides: [[0, 0, 1], [1, 0, 0]], cells: [1, 1] } }, mass: 1, springs: { structural: { ks: 1 } }, color: [255, 0, 0, 255] }],
    strands: [{ form: { curve: [[0, 0, 0], [0, -1, 0]] }, segments: 4, radius: 1e-3, young: 1e6, density: 1000, width: 0.01 }],
    lights: [{ directional: { color: [1, 1, 1], direction: [1, 0, 0] } }],
    ambient: [0.5, 0.5, 0.5],
  });
  assert.equal(held.boxes().length, 0);
  const surfaces = held.surfaces();
  assert.equal(surfaces.length, (2 + 8) * 30);
  near([...surfaces.slice(3, 10)], [0, 1, 0, 1, 0, 0, 1]);
  for (let at = 2 * 30; at < surfaces.length; at += 10) {
    const [place, normal] = [surfaces.slice(at, at + 3), surfaces.slice(at + 3, at + 6)];
    place[1] -= 1; // Its corners are one from its middle, its faces 1/√3, and these look away from it.
    near([Math.hypot(...place), place.reduce((sum, x, i) => sum + x * normal[i], 0)], [1, Math.sqrt(1 / 3)]);
  }
  const strands = held.strands([0, 0, 9]);
  assert.equal(strands.length, 4 * 16);
  near([...strands.slice(0, 8)], [0, 0, 0, 0, -0.25, 0, 0.01, 0.01]);
  assert.ok(strands[8] > 0.99 && strands[11] === 1, "the light falls across it");
  refuses(() => held.strands([0, 1]), /^eye has to be three finite numbers/);
  held.free();
  const spring = world.springs();
  near([...spring.slice(0, 8)], [0, 5, 0, 0, 7.2, 0, 0, 0]);
  assert.ok(spring[8] > 0.9 && spring[10] < 0.25, "longer by a tenth is red");
  const trails = world.trails();
  let way = 0;
  for (let at = 0; at < trails.length; at += 16) way += Math.hypot(...[0, 1, 2].map((i) => trails[at + i] - trails[at + 3 + i]));
  assert.ok(Math.abs(way - 0.5 * (3 + 1)) < 0.02, `${way} m`);
  world.restart();
  const begun = world.trails();
  for (let at = 0; at < begun.length; at += 16) near([...begun.slice(at, at + 3)], [...begun.slice(at + 3, at + 6)]);
  for (const eye of [undefined, null, 7, [], [1, 2], [1, 2, NaN], [1, 2, 3, 4], "abc", {}])
    refuses(() => world.sprites(eye), /^eye has to be three finite numbers/);
  refuses(() => world.sprites([0, 0, 9], [0, 1]), /^up has to be three finite numbers/);
  world.free();
});
