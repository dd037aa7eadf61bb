// Whatever the package is given, it works or throws an Error with a sentence, and the next world computes what it should.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { afterEach, test } from "node:test";
import { runInNewContext } from "node:vm";
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

// A scene of the repository, as an object.
const load = (name) => JSON.parse(readFileSync(new URL(`../../scenes/${name}.json`, import.meta.url), "utf8"));

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
    refuses(() => new World(other), /^a scene has to be an object, or its text, not /);
  }
  // What has no fields of its own would be an empty scene, without a word.
  const revoked = Proxy.revocable({}, {});
  revoked.revoke();
  for (const [other, name] of [
    [Promise.resolve(scene), "a Promise: await it"], [new Response("{}"), "a Response: await its json()"], [new Map(), "a Map"],
    [new ArrayBuffer(8), "an ArrayBuffer"], [new Float32Array(3), "a Float32Array"], [new String("{}"), "a String"], [[scene], "an Array"],
    [new (class Mine { run = {} })(), "a Mine"], [null, "null"], [undefined, "undefined"], [7, "a number"], [revoked.proxy, "an object"],
  ]) {
    assert.throws(() => new World(other), { message: `a scene has to be an object, or its text, not ${name}` });
  }
  for (const empty of ["", " \n", "\ufeff"]) refuses(() => new World(empty), /^the text is empty/);
  assert.equal(hash(Object.assign(Object.create(null), scene)), expected);
  assert.equal(hash(new (class Mine { toJSON() { return scene; } })()), expected);
  refuses(() => new World(circular), /^scene:self: has no JSON: it is part of itself$/);
  refuses(() => new World({ run: { seed: 7n } }), /^scene:run\.seed: has no JSON: it is a bigint: write it as a number$/);
  for (const other of [undefined, null, 7, [], "particle 0 0 0"]) {
    refuses(() => new World({ toJSON: () => other }), /the scene has no JSON/);
  }
  refuses(() => new World({ toJSON() { throw 7; } }), /the scene has no JSON/);
  refuses(() => new World({ toJSON() { throw { get message() { throw 7; } }; } }), /the scene has no JSON/);
  refuses(() => new World("x".repeat(40 << 20)), /characters/);
  refuses(() => new World(`{"particles": [${"{},".repeat(4e6)}{}]}`), /not enough memory/);
});

test("errors in objects have paths", () => {
  const shape = (form) => ({ scenery: [{ shape: { sphere: { center: [0, 0, 0], radius: 1 } } }, { shape: form }] });
  for (const [other, message] of [
    [{ particles: 7 }, "scene:particles: invalid type: integer `7`, expected a sequence"],
    [{ particles: [{}, { position: [0, 0] }] }, /^scene:particles\[1\]\.position: invalid length 2/],
    [{ particles: [{ mass: "heavy" }] }, /^scene:particles\[0\]\.mass: invalid type: string "heavy", expected a number$/],
    [{ particles: [{ mass: -1 }] }, /^scene:particles\[0\]\.mass: has to be above zero/],
    [{ particles: [{ position: [0, [1], 0] }] }, /^scene:particles\[0\]\.position\[1\]: /],
    [{ particles: [{ weight: 1 }] }, /^scene:particles\[0\]\.weight: unknown field `weight`/],
    [shape({ plane: { point: [0, 0], normal: [0, 1, 0] } }), /^scene:scenery\[1\]\.shape\.plane\.point: invalid length 2/],
    [shape({ plane: { point: [0, 0, 0] } }), /^scene:scenery\[1\]\.shape\.plane: missing field `normal`/],
    [{ about: 'a "{[\\', run: { dt: true } }, /^scene:run\.dt: /],
    // JSON knows no NaN and would say null.
    [{ particles: [{ position: [0, NaN, 0] }] }, "scene:particles[0].position[1]: invalid value: NaN, expected a number"],
    [{ particles: [{ lifetime: -Infinity }] }, "scene:particles[0].lifetime: invalid value: -Infinity, expected a number"],
    [{ springs: [{ ends: [0, 1], rest_length: 1, ks: 1, kd: 0, breaks_at: NaN }], particles: [{}, {}] }, /^scene:springs\[0\]\.breaks_at: invalid value: NaN/],
  ]) assert.throws(() => new World(other), { message });
  refuses(() => new World('{"particles": 7}'), /^scene:1:\d+: /);
});

test("what JSON cannot say is refused by its path", () => {
  class Empty {}
  class Mine { mass = 2; }
  const detached = new Float32Array([1, 2, 3]);
  structuredClone(detached, { transfer: [detached.buffer] });
  const loop = [{}];
  loop[0].inner = { loop };
  const deep = JSON.parse('{"a":'.repeat(200) + "1" + "}".repeat(200));
  const kinds = [
    [Promise.resolve({}), "it is a Promise: await it"], [new Map([["mass", 2]]), "it is a Map"], [new Set(), "it is a Set"], [new Empty(), "it is an Empty"],
    [() => 7, "it is a function"], [Symbol("mass"), "it is a symbol"], [7n, "it is a bigint: write it as a number"], [/x/, "it is a RegExp"],
    [new ArrayBuffer(8), "it is an ArrayBuffer"], [new DataView(new ArrayBuffer(8)), "it is a DataView"],
    [detached, "it is a Float32Array that cannot be read, as one that has been transferred"],
  ];
  const ball = new World({});
  for (const [value, why] of kinds) {
    for (const [scene, place] of [
      [{ particles: [{}, value] }, "scene:particles[1]"],
      [{ forces: [], particles: [{ position: [1, 2, 3], velocity: {} }, { color: [[], {}], mass: value }] }, "scene:particles[1].mass"],
      [{ "a b": { c: [[], [[1], value]] } }, "scene:a b.c[1][1]"],
      [{ contacts: value }, "scene:contacts"],
    ]) {
      refuses(() => new World(scene), /^scene/);
      assert.throws(() => new World(scene), { message: `${place}: has no JSON: ${why}` });
    }
    assert.throws(() => ball.spawn({ position: [0, 0, 0], mass: value }), { message: `particle.mass: has no JSON: ${why}` });
    assert.throws(() => ball.spawn({ position: [0, value, 0] }), { message: `particle.position[1]: has no JSON: ${why}` });
  }
  assert.equal(ball.count, 0);
  for (const [scene, message] of [
    [{ particles: loop }, "scene:particles[0].inner.loop: has no JSON: it is part of itself"],
    [{ particles: [{ position: new BigInt64Array(3) }] }, "scene:particles[0].position[0]: has no JSON: it is a bigint: write it as a number"],
    [{ about: deep }, /^scene:about\.a\..*: has no JSON: it is 128 objects deep$/],
    [{ ["x".repeat(1e6)]: { y: 1n } }, `scene:${"x".repeat(60)}….y: has no JSON: it is a bigint: write it as a number`],
    [{ toJSON: () => new Map() }, "the scene has no JSON: it is a Map"],
    [{ particles: [new (class { mass = 1; toJSON() { return new Set(); } })()] }, "scene:particles[0]: has no JSON: it is a Set"],
  ]) {
    assert.throws(() => new World(scene), { message });
  }
  // What is there twice is not within itself, and what has fields says what it is by these.
  const place = [1, 2, 3];
  const fine = new World({ about: undefined, particles: [{ position: place, velocity: place }, new Mine(), { mass: new Number(3), position: new Float32Array(3) }] });
  assert.deepEqual([fine.count, ...fine.positions().slice(0, 3), ...fine.velocities().slice(0, 3)], [3, 1, 2, 3, 1, 2, 3]);
  for (const world of [ball, fine]) world.free();
});

test("too little room for what a scene begins with is told", () => {
  const boxes = { boxes: [{ sides: [1, 1, 1], mass: 1, position: [0, 0, 0], count: [1, 2, 1] }] };
  for (const [capacity, count, told] of [[15, 15, 1], [0, 0, 1], [16, 16, 0], [17, 16, 0], [null, 16, 0]]) {
    const world = new World(boxes, null, capacity);
    assert.deepEqual([world.count, JSON.parse(world.report()).refused], [count, 16 - count]);
    const warning = `a capacity of ${capacity} is less than the 16 particles that the scene begins with: the last of them are refused, and bodies that these are part of are cut`;
    assert.deepEqual(world.warnings, told === 1 ? [warning] : []);
    world.free();
  }
});

test("arrays of other windows are arrays", () => {
  const files = new Files();
  const elsewhere = (code) => runInNewContext(code);
  files.addMesh("a", elsewhere("new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0])"), elsewhere("new Uint32Array([0, 1, 2])"));
  new World({ scenery: [{ shape: { mesh: "a" } }] }, files).free();
  for (const [coordinates, indices] of [["new Uint32Array(9)", "new Uint32Array(3)"], ["new Float32Array(9)", "new Int32Array(3)"], ["[0]", "[0]"], ["({ length: 9, [Symbol.toStringTag]: 'Float32Array' })", "new Uint32Array(3)"]]) {
    refuses(() => files.addMesh("a", elsewhere(coordinates), elsewhere(indices)), /^a: coordinates have to be a Float32Array, and indices a Uint32Array/);
  }
  files.free();
});

test("scenes give cause to remarks", () => {
  const old = { ...scene, emitters: [{ ...scene.emitters[0], speed: { mean: 5, variance: 1 }, elasticity: 2 }] };
  const [name, odd, ...others] = new World(old).warnings;
  assert.equal(name, "scene:emitters[0].speed: `variance` is called `half_width` now");
  assert.match(odd, /^scene:emitters\[0\]\.elasticity: 2 is above 1/);
  assert.deepEqual(others, []);
  assert.match(new World(JSON.stringify(old, null, 1)).warnings[0], /^scene:\d+:\d+: `variance` is called `half_width` now$/);
  assert.deepEqual(new World({ fabrics: [] }).warnings, ["scene: `fabrics` is called `cloths` now"]);
  assert.deepEqual(new World(scene).warnings, []);
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
  const others = [Infinity, -Infinity, NaN, -1, undefined, null, "1", "soon", {}, [1], 1n, true, new Date(), Symbol("1"), new Number(1)];
  for (const seconds of others) {
    refuses(() => world.step(seconds), /^step has to be given a finite number of seconds/);
    refuses(() => world.stepTo(seconds), /^stepTo has to be given a finite number of seconds/);
    refuses(() => world.advance(seconds), /^advance has to be given a finite number of seconds/);
  }
  for (const most of [0, -1, 0.5, NaN, 2 ** 32, "8", {}]) refuses(() => world.advance(0, most), /^the most steps has to be a whole number from 1/);
  assert.throws(() => world.step(-Infinity), { message: "step has to be given a finite number of seconds, zero or more, not -Infinity" });
  for (const full of [0, -1, NaN, Infinity, 1e-300, 1e300, "1", {}, 1n]) {
    refuses(() => world.springs(full), /^the full strain has to be a finite number above zero/);
    refuses(() => world.links(full), /^the full strain has to be a finite number above zero/);
  }
  assert.equal(world.time, 0);
  world.step(0);
  for (const seconds of [1e-9, 1e3, 1e9]) world.step(seconds);
  const time = world.time;
  for (const seconds of [2 ** 32, 1e12, Number.MAX_VALUE]) {
    refuses(() => world.step(seconds), /^step would reach the end of time/);
    refuses(() => world.stepTo(seconds), /^stepTo would reach the end of time/);
  }
  assert.equal(world.time, time);
  assert.ok(world.count <= 100);
  world.stepTo(2 ** 32 - 1e-3);
  refuses(() => world.advance(1), /^advance would reach the end of time/);
  world.restart();
  for (let frame = 1; frame <= 120; frame++) world.stepTo(frame / 60);
  assert.equal(world.hash(), expected);
  world.stepTo(1);
  assert.equal(world.time, 2, "not back");
  assert.equal(world.hash(), expected, "no step at all");
  world.free();
});

test("what is passed cannot free a world on the way", () => {
  for (const method of ["step", "stepTo", "springs", "advance"]) {
    const world = new World(load("net"));
    refuses(() => world[method]({ valueOf() { world.free(); return 0.1; } }), /has to be/);
    assert.equal(world.count, 169);
    world.free();
  }
});

test("exceptions of others leave the package as it was", () => {
  const world = new World(scene);
  world.step(1);
  const boom = () => { throw new Error("boom"); };
  for (const eye of [
    { length: 3, get 0() { return boom(); } }, { get length() { return boom(); } }, new Proxy([1, 2, 3], { get: boom }),
    { [Symbol.iterator]: boom }, { [Symbol.iterator]: () => ({ next: () => null }) }, { [Symbol.iterator]: () => ({ get next() { return boom(); } }) },
    { length: 3, get 0() { world.step(1); return 0; }, 1: 0, 2: 0 },
  ]) {
    refuses(() => world.sprites(eye), /^eye has to be three finite numbers/);
    refuses(() => world.sprites([0, 0, 9], eye), /^up has to be three finite numbers/);
    refuses(() => world.strands(eye), /^eye has to be three finite numbers/);
    world.step(0.1);
  }
  assert.equal(world.sprites({ length: 3, 0: 1, 1: 2, 2: 3 }).length, 0);
  world.free();
  const detached = new Float32Array(9);
  structuredClone(detached.buffer, { transfer: [detached.buffer] });
  class Throws extends Float32Array { get length() { return boom(); } }
  class Lies extends Float32Array { get length() { return 9; } }
  const corners = new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]);
  const files = new Files();
  const face = new Uint32Array([0, 1, 2]);
  files.addMesh("throws", new Throws(corners), face);
  for (const other of [detached, Object.create(corners), Object.setPrototypeOf(new Float32Array(4), Lies.prototype), new Proxy(corners, { get: boom })]) {
    refuses(() => files.addMesh("m", other, face), /^m: coordinates/);
    files.addMesh("m", corners, face);
  }
  assert.equal(new World({ scenery: [{ shape: { mesh: "throws" } }] }, files).count, 0);
  files.free();
});

test("what has been freed says so, and may be freed again", () => {
  const world = new World(scene);
  const files = new Files();
  for (let i = 0; i < 3; i++) {
    world.free();
    files.free();
    if (Symbol.dispose) world[Symbol.dispose]();
  }
  for (const name of ["step", "positions", "advance", "restart", "hash", "spawn"]) refuses(() => world[name](1), /^this World has been freed$/);
  for (const name of ["count", "time", "dt", "warnings"]) refuses(() => world[name], /^this World has been freed$/);
  refuses(() => files.addText("a", "b"), /^this Files has been freed$/);
  const others = new Files();
  refuses(() => World.prototype.step.call(others, 1), /^this has to be a World of pointmass$/);
  refuses(() => World.prototype.step.call({ __wbg_ptr: 12345678 }, 1), /^this has to be a World of pointmass$/);
});

test("before init there is a sentence", async () => {
  const pointmass = await import("../../target/npm/pointmass.js?unready");
  for (const call of [() => new pointmass.World(scene), () => new pointmass.Files(), () => pointmass.version()]) {
    refuses(call, /^pointmass is not loaded yet: call `await init\(\)` first/);
  }
});

test("frames of any lengths make the scene's own steps", () => {
  const world = new World({ ...scene, run: { ...scene.run, dt: 0.01 } });
  assert.equal(world.dt, 0.01);
  const at = {};
  for (let step = 1; step <= 100; step++) {
    world.stepTo(step * 0.01);
    at[world.time] = world.hash();
  }
  const whole = world.hash();
  // All of these sum up to a second.
  const uneven = [0.1, 0.003, 0.007, 0.09, 0.05, 0, 0.0125, 0.0375, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1];
  for (const frames of [Array(60).fill(1 / 60), Array(144).fill(1 / 144), Array(10).fill(0.1), uneven]) {
    world.restart();
    for (const elapsed of frames) {
      const share = world.advance(elapsed);
      assert.ok(share >= 0 && share <= 1);
      assert.ok(world.time === 0 || at[world.time] === world.hash(), `at ${world.time}`);
    }
    assert.equal(world.hash(), whole);
  }
  // A hidden tab: ten steps are a tenth of a second, of the others nothing is left.
  world.restart();
  assert.ok(Math.abs(world.advance(3600.005) - 0.5) < 1e-3);
  assert.ok(Math.abs(world.time - 0.1) < 1e-9);
  assert.ok(world.advance(0.004, 1) > 0.89);
  assert.ok(world.advance(0.5, 3) < 0.91);
  assert.ok(Math.abs(world.time - 0.13) < 1e-9);
  // Elsewhere in the meantime: the next step ends at the next multiple.
  world.step(0.004);
  world.advance(0.011, 1);
  assert.ok(Math.abs(world.time - 0.14) < 1e-9);
  world.advance(0.008);
  world.restart();
  assert.equal(world.advance(0), 0, "nothing is left over");
  world.free();
});

test("a frame that lasts breaks nothing", () => {
  for (const name of ["flag", "hundred_dice", "net"]) {
    const world = new World(load(name));
    for (const elapsed of [1 / 60, 1 / 60, 0.1, 0.3, 1 / 60]) world.advance(elapsed);
    const farthest = world.positions().subarray(0, 3 * world.count).reduce((most, x) => Math.max(most, Math.abs(x)), 0);
    assert.ok(farthest < 20, `${name}: ${farthest} m`);
    world.free();
  }
});

test("particles are put in and taken out", () => {
  const world = new World({
    particles: [{}],
    materials: [{ diffuse: [1, 0, 0] }],
    forces: [{ gravity: { acceleration: [0, -10, 0] } }],
    contacts: { force: { stiffness: 1e4 } },
  }, null, 3);
  const id = world.spawn({ position: [1, 2, 3], velocity: new Float32Array([0, 1, 0]), radius: 0.5, mass: 2, material: 0 });
  assert.deepEqual([id, world.count, [...world.ids()]], [1, 2, [0, 1]]);
  assert.deepEqual([...world.positions().slice(3, 6), world.velocities()[4], world.radii()[1]], [1, 2, 3, 1, 0.5]);
  assert.deepEqual([...world.colors()], [255, 255, 255, 255, 255, 0, 0, 255]);
  assert.deepEqual([...world.materials()], [-1, 0]);
  // It meets others as balls do, though the scene has none.
  const other = world.spawn({ position: [1.5, 2, 3], radius: 0.5, color: [1, 2, 3, 4] });
  for (let i = 0; i < 30; i++) world.advance(1 / 60);
  assert.ok(world.positions()[6] - world.positions()[3] > 0.9, `${world.positions()[6] - world.positions()[3]}`);
  assert.equal(world.spawn({}), undefined);
  assert.equal(JSON.parse(world.report()).refused, 1);
  assert.deepEqual([world.remove(id), world.remove(id), world.remove(99)], [true, false, false]);
  assert.deepEqual([...world.ids()], [0, other]);
  assert.equal(world.spawn({ lifetime: 0.5 }), 3);
  for (let i = 0; i < 60; i++) world.advance(1 / 60);
  assert.deepEqual([...world.ids()], [0, other]);
  for (const [particle, pattern] of [
    [undefined, /^a particle has to be an object, not undefined$/], [[], /not an Array$/], [Promise.resolve({}), /not a Promise: await it$/],
    [{ mass: 0 }, /^particle\.mass: has to be above zero/], [{ position: [0, NaN, 0] }, /^particle\.position\[1\]: invalid value: NaN/],
    [{ weight: 1 }, /^particle\.weight: unknown field `weight`/], [{ material: 1 }, /^particle\.material: 1 is out of range/],
    [{ position: [0, 0] }, /^particle\.position: invalid length 2/], [{ toJSON() { world.free(); throw 7; } }, /has no JSON/],
  ]) refuses(() => (world.__wbg_ptr ? world : new World({})).spawn(particle), pattern);
  for (const id of [undefined, null, -1, 0.5, "0", {}]) refuses(() => new World({}).remove(id), /^an id has to be/);
});

test("each particle is drawn once, as the program draws it", () => {
  const box = { form: { box: { min: [-1, -1, -1], max: [1, 1, 1] } } };
  const world = new World({
    materials: [{ size: 0.2, sprite: { picture: "puff" } }, { size: 2, shape: box }, { size: 0.1 }],
    particles: [{ material: 0 }, { radius: 1, material: 2 }, { material: 1 }, {}, { color: [1, 2, 3, 0] }, { radius: 0.5 }],
    boxes: [{ sides: [1, 1, 1], mass: 1, position: [5, 5, 5] }],
    cloths: [{ form: { sheet: { corner: [5, 0, 0], sides: [[0, 0, 1], [1, 0, 0]], cells: [2, 2] } }, mass: 1, springs: { structural: { ks: 1 } } }],
    strands: [{ form: { curve: [[0, 0, 0], [0, -1, 0]] }, segments: 4, radius: 1e-3, young: 1e6, density: 1000 }],
  });
  assert.ok(world.count > 6 + 9);
  assert.deepEqual([...world.points()], [1, 3, 5]);
  assert.deepEqual([...world.materials().slice(0, 6)], [0, 2, 1, -1, -1, -1]);
  world.free();
  const campfire = new World(load("campfire"));
  for (let i = 0; i < 60; i++) campfire.advance(1 / 60);
  const [points, sprites] = [campfire.points().length, campfire.sprites([0, 1, 5]).length / 16];
  assert.ok(points > 10 && sprites > 10 && points + sprites <= campfire.count, `${points} + ${sprites} of ${campfire.count}`);
  campfire.free();
});

test("links of constraints are lines", () => {
  const chain = new World(load("chain"));
  assert.equal(chain.springs().length, 0);
  assert.equal(chain.links().length, 26 * 16);
  const [x, y, z, u, v, w] = chain.links();
  const [first, second] = [[...chain.positions().slice(0, 3)], [...chain.positions().slice(3, 6)]];
  assert.deepEqual([[x, y, z], [u, v, w]], [first, second]);
  chain.free();
  // The segments of ropes are curves.
  const rope = new World(load("tied"));
  assert.equal(rope.links().length, 0);
  assert.ok(rope.strands([0, 0, 9]).length > 0);
  rope.free();
});

// The package once more, in a memory of so many pages of 64 KiB: the module's section 5 says how many it may have.
async function cramped(pages) {
  const bytes = readFileSync(new URL("../../target/npm/pointmass_bg.wasm", import.meta.url));
  const leb = (number) => (number < 128 ? [number] : [(number % 128) + 128, ...leb(Math.floor(number / 128))]);
  const number = (at) => (bytes[at] < 128 ? [bytes[at], at + 1] : ((rest) => [bytes[at] - 128 + 128 * rest[0], rest[1]])(number(at + 1)));
  for (let at = 8; at < bytes.length; ) {
    const [size, begin] = number(at + 1);
    if (bytes[at] === 5) {
      const [least] = number(begin + 2);
      const section = [1, 1, ...leb(least), ...leb(pages)];
      const module = Buffer.concat([bytes.subarray(0, at), Buffer.from([5, section.length, ...section]), bytes.subarray(begin + size)]);
      const pointmass = await import("../../target/npm/pointmass.js?cramped");
      pointmass.initSync({ module });
      return pointmass;
    }
    at = begin + size;
  }
  assert.fail("the module has no memory");
}

test("whatever finds no memory is refused, and goes on when there is some", async () => {
  const { World, Files } = await cramped(2048);
  const leaves = { ...scene, run: { capacity: 5000 }, materials: [{ size: 1, sprite: { picture: "leaf" }, trail: { seconds: 1 } }] };
  leaves.emitters = [{ ...scene.emitters[0], rate: 1e5, material: 0 }];
  const worlds = [new World(leaves), new World(load("flag")), new World(load("hundred_dice")), new World(load("chain"))];
  for (const world of worlds) world.advance(0.05);
  const files = new Files();
  const kept = [];
  for (let capacity = 1e6; capacity >= 1; ) {
    try {
      kept.push(new World({}, null, capacity));
    } catch (error) {
      assert.match(error.message, /not enough memory/);
      capacity = Math.floor(capacity / 2);
    }
  }
  // Texts fill what is too small for a world.
  const filling = new Files();
  for (let length = 1e6; length >= 1; ) {
    try {
      for (let i = 0; ; i++) filling.addText(`${length} ${i}`, "x".repeat(length));
    } catch (error) {
      assert.match(error.message, /not enough memory/);
      length = Math.floor(length / 2);
    }
  }
  let refused = [];
  const tried = (action) => {
    try {
      action();
    } catch (error) {
      assert.ok(!(error instanceof WebAssembly.RuntimeError), error.stack);
      assert.match(error.message, /not enough memory/);
      refused.push(error.message);
    }
  };
  const lists = ["colors", "looks", "ids", "materials", "points", "trails", "shapes", "surfaces", "springs", "links", "boxes", "hash", "report"];
  const use = (world) => {
    for (const list of lists) tried(() => world[list]());
    tried(() => world.sprites([0, 1, 5]));
    tried(() => world.strands([0, 1, 5]));
    tried(() => world.warnings);
    tried(() => world.spawn({}));
    tried(() => world.restart());
    tried(() => world.advance(1 / 60));
  };
  const all = () => {
    worlds.forEach(use);
    tried(() => files.addText("text", "y".repeat(1e6)));
    tried(() => files.addMesh("mesh", new Float32Array(9e4), new Uint32Array(9e4)));
    tried(() => kept.push(new World({ particles: Array(1e4).fill({}) })));
    tried(() => new Files());
    refuses(() => worlds[0].custom("x".repeat(3e7)), /may have|not enough memory/);
  };
  all();
  assert.ok(refused.length > 20, `${refused}`);
  for (const world of kept.splice(0)) world.free();
  filling.free();
  refused = [];
  all();
  assert.deepEqual(refused, []);
  for (const world of [...worlds, ...kept]) world.free();
  files.free();
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

test("views cover the capacity and outlive steps", async () => {
  // Once more, with memory that nobody has made grow.
  const { World, initSync } = await import("../../target/npm/pointmass.js?views");
  initSync({ module: readFileSync(new URL("../../target/npm/pointmass_bg.wasm", import.meta.url)) });
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
  assert.deepEqual([dice.boxes()[16], dice.materials()[0]], [-1, -1]);
  const painted = new World({ materials: [{}, {}], boxes: [0, 1].map((material) => ({ sides: [1, 1, 1], mass: 1, position: [3 * material, 0, 0], material })) });
  assert.deepEqual([painted.boxes()[16], painted.boxes()[33]], [0, 1]);
  painted.free();
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

test("balls that were put in leave nothing behind", () => {
  const balls = Array.from({ length: 150 }, (_, i) => ({
    position: [(i % 5) * 0.19, 0.2 + 0.19 * Math.floor(i / 25), 0.19 * (Math.floor(i / 5) % 5)],
    radius: 0.1,
  }));
  const world = new World({
    run: { dt: 0.01, capacity: 200 },
    contacts: { force: { stiffness: 1000, damping: 1 } },
    forces: [{ gravity: { acceleration: [0, -9.8, 0] } }],
    particles: balls,
    scenery: [{ shape: { plane: { point: [0, 0, 0], normal: [0, 1, 0] } } }],
  });
  const end = () => {
    for (let i = 0; i < 30; i++) world.advance(0.01);
    return world.hash();
  };
  const begun = world.save();
  const expected = end();
  for (const radius of [0.1, 0.3, 5]) {
    world.restore(begun);
    world.spawn({ position: [50, 100, 0], radius });
    const wide = world.save();
    const beside = end();
    world.restore(begun);
    assert.equal(end(), expected, `restored, ${radius} m`);
    world.restart();
    assert.equal(end(), expected, `restarted, ${radius} m`);
    world.restore(wide);
    assert.equal(end(), beside, `with it again, ${radius} m`);
  }
  world.free();
});

test("names that stand alone are told of where they stand", () => {
  for (const [scene, place] of [
    [{ forces: [{ drag: {} }, "drag", { drag: {} }] }, "scene:forces[1]: a name alone"],
    [{ forces: ["drag"] }, "scene:forces[0]: a name alone"],
    [{ contacts: "impulse" }, "scene:contacts: a name alone"],
  ]) {
    refuses(() => new World(scene), new RegExp("^" + place.replaceAll("[", "\\[")));
  }
});

test("a world goes back to what was saved", () => {
  for (const name of ["fountain", "fireworks", "dice", "flag"]) {
    const world = new World(load(name));
    world.stepTo(0.5);
    assert.equal(world.advance(world.dt * 2.5).toFixed(3), "0.500");
    const view = world.positions();
    const [first, hash] = [world.save(), world.hash()];
    const ends = [0, 1].map(() => {
      if (view.length > 0) assert.deepEqual(view.slice(0, 3), world.positions().slice(0, 3));
      world.spawn({ position: [0, 3, 0], lifetime: 1 });
      const share = world.advance(world.dt * 3.2);
      const end = [share, world.count, world.time, world.hash(), world.report(), String(world.trails()), world.save()];
      world.restore(first);
      assert.equal(world.hash(), hash, name);
      return end;
    });
    const [one, other] = ends.map((end) => end.pop());
    assert.deepEqual(ends[0], ends[1], name);
    assert.ok(other > one && one > first, "no number is given twice");
    // On to another state, whatever has happened since.
    world.restart();
    world.restore(other);
    assert.equal(world.hash(), ends[1][3]);
    assert.deepEqual([world.forget(one), world.forget(one), world.forget(99)], [true, false, false]);
    refuses(() => world.restore(one), /^no state \d+ is saved: save\(\) gives the numbers$/);
    for (const wrong of [undefined, null, "0", {}, 0n]) {
      refuses(() => world.restore(wrong), /^a state has to be a/);
      refuses(() => world.forget(wrong), /^a state has to be a/);
    }
    for (const wrong of [-1, 0.5, NaN, 2 ** 32]) refuses(() => world.restore(wrong), /^a state has to be a whole number from 0 to 4294967295, not /);
    world.restore(first);
    assert.equal(world.hash(), hash);
    world.free();
  }
  // States take memory until there is none, and are given back.
  const large = new World({}, null, 4e6);
  const states = [];
  refuses(() => { for (;;) states.push(large.save()); }, /^there is not enough memory for one more state of the world$/);
  assert.ok(states.length > 1 && states.every((state) => large.forget(state)));
  large.forget(large.save());
  large.free();
});

test("blows are told", () => {
  const gravity = { forces: [{ gravity: { acceleration: [0, -10, 0] } }], run: { dt: 0.01, substeps: 1 } };
  const ground = { scenery: [{ shape: { plane: { point: [0, 0, 0], normal: [0, 1, 0] } } }] };
  const ball = (x, y, more) => ({ position: [x, y, 0], radius: 0.1, elasticity: 0.5, ...more });
  const scene = { ...gravity, ...ground, particles: [ball(0, 5.050125), ball(3, 5.050125, { mass: 2 })] };
  const [heard, deaf] = [new World(scene), new World(scene)];
  assert.deepEqual([heard.blows().length, heard.struck().length, heard.missedBlows], [0, 0, 0]);
  heard.listen();
  let count = 0;
  for (let frame = 1; frame <= 120; frame++) {
    for (const world of [heard, deaf]) world.advance(0.01);
    const [blows, struck] = [heard.blows(), heard.struck()];
    assert.deepEqual([blows.length / 12, deaf.blows().length], [struck.length / 2, 0]);
    if (frame === 100) assert.deepEqual([...struck].toSorted((a, b) => a - b), [0, 1, 2 ** 32 - 1, 2 ** 32 - 1]);
    for (let i = 0; i < struck.length; i += 2, count++) {
      // At 9.95 m/s, 0.995 s after the beginning; half of that it keeps.
      const blow = [...blows.slice(6 * i, 6 * i + 12)];
      const expected = [3 * struck[i], 0.1, 0, 0, 1, 0, 0, 14.925, 0, 9.95, struck[i] + 1];
      expected.forEach((number, k) => assert.ok(Math.abs(blow[k] - number) < 1e-3, `${k}: ${blow}`));
      assert.ok(Math.abs(heard.time - blow[11] - 0.995) < 1e-4, String(blow));
    }
  }
  assert.equal(count, 2);
  assert.equal(heard.hash(), deaf.hash());
  // More than there is room for, a speed that nobody has, and nothing any more.
  for (const [least, most, told, missed] of [[null, 1, 1, 1], [9.9, null, 2, 0], [10.1, 5, 0, 0], [0, 0, 0, 0], [Infinity, 3, 0, 0]]) {
    heard.restart();
    heard.listen(least, most);
    heard.stepTo(0.99);
    heard.step(0.02);
    assert.deepEqual([heard.struck().length / 2, heard.missedBlows], [told, most === 0 ? 0 : missed], `${least} ${most}`);
    heard.stepTo(1.02);
    assert.deepEqual([heard.blows().length, heard.missedBlows], [0, 0], "each call begins anew");
  }
  // Two rigid boxes that meet in the air are told of each other, by their first particles.
  const boxes = new World({ ...gravity, forces: [], boxes: [0, 1].map((i) => ({ sides: [0.2, 0.2, 0.2], mass: 1, position: [i, 0, 0], velocity: [1 - 2 * i, 0, 0] })) });
  boxes.listen();
  let met = [];
  for (let frame = 1; frame <= 60 && met.length === 0; frame++) {
    boxes.advance(0.01);
    met = [...boxes.struck()];
  }
  assert.deepEqual(met.toSorted((a, b) => a - b), [0, 0, 8, 8]);
  assert.ok(Math.abs(boxes.blows()[9] - 2) < 0.01, String(boxes.blows()));
  // Nobody who does not listen misses anything.
  const box = { sides: [0.2, 0.2, 0.2], mass: 1, position: [0, 0.5, 0] };
  for (const listen of [() => {}, (world) => world.listen(0, 0), (world) => { world.listen(); world.listen(0, 0); }]) {
    const world = new World({ ...gravity, ...ground, boxes: [box], particles: [ball(3, 0.5), ball(3, 0.9)], contacts: { impulse: {} } });
    listen(world);
    for (let frame = 1; frame <= 60; frame++) {
      world.advance(0.01);
      assert.deepEqual([world.blows().length, world.missedBlows], [0, 0]);
    }
    world.free();
  }
  for (const wrong of [-1, NaN, "1", {}, 1n]) refuses(() => boxes.listen(wrong), /^the speed of a blow has to be a number, zero or more, not /);
  for (const wrong of [-1, 0.5, "1", 2 ** 32]) refuses(() => boxes.listen(1, wrong), /^the most blows has to be a whole number from 0 to /);
  refuses(() => boxes.listen(1, 4e9), /^there is not enough memory for so many blows$/);
  for (const world of [heard, deaf, boxes]) world.free();
});
