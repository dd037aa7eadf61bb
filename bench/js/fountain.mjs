// A fountain over the ground in WebAssembly, beside what somebody would write by hand in JavaScript, in turns:
//   wasm/build && node bench/js/fountain.mjs [PARTICLES] [STEPS] [ROUNDS]
// 10 m/s, a drag of 0.2/s, lives of 3 to 5 s, a restitution of 0.5. The loop by hand turns round what is below the ground;
// ours finds each hit at its instant. Prints the least time a particle and step of all rounds.
import { World } from "../../target/npm/node.js";

const [particles = 100_000, steps = 20, rounds = 16] = process.argv.slice(2).map(Number);
const dt = 1 / 60;
const rate = particles / 4;
// Of the nozzle: so high that a tenth of the particles touch the ground in a step.
const height = 2.25;

const scene = {
  emitters: [
    {
      shape: { circle: { center: [0, height, 0], normal: [0, 1, 0], radius: 0.1 } },
      rate,
      speed: { mean: 10, half_width: 1 },
      spread: { uniform: 0.3 },
      drag: { mean: 0.2, half_width: 0 },
      elasticity: { mean: 0.5, half_width: 0 },
      lifetime: { mean: 4, half_width: 1 },
    },
  ],
  forces: [{ gravity: { acceleration: [0, -9.80665, 0] } }, { drag: {} }],
  scenery: [{ shape: { plane: { point: [0, 0, 0], normal: [0, 1, 0] } } }],
  run: { integrator: "symplectic" },
};

/** One typed array for each number of a particle; the last one takes the place of a dead one. */
class ByHand {
  constructor(capacity) {
    this.columns = Array.from({ length: 8 }, () => new Float32Array(capacity));
    this.length = 0;
    this.time = 0;
    this.owed = 0;
  }

  step() {
    const [x, y, z, u, v, w, drag, dies] = this.columns;
    this.time += dt;
    for (this.owed += rate * dt; this.owed >= 1 && this.length < x.length; this.owed -= 1) {
      const i = this.length++;
      const turn = 2 * Math.PI * Math.random();
      const lean = 0.3 * Math.sqrt(Math.random());
      const speed = 9 + 2 * Math.random();
      [x[i], y[i], z[i]] = [0.1 * Math.cos(turn), height, 0.1 * Math.sin(turn)];
      u[i] = speed * Math.sin(lean) * Math.cos(turn);
      v[i] = speed * Math.cos(lean);
      w[i] = speed * Math.sin(lean) * Math.sin(turn);
      drag[i] = 0.2;
      dies[i] = this.time + 3 + 2 * Math.random();
    }
    const now = this.time;
    let length = this.length;
    for (let i = 0; i < length; i++) {
      if (dies[i] <= now) {
        length--;
        for (const column of this.columns) column[i] = column[length];
        i--;
        continue;
      }
      const kept = 1 - drag[i] * dt;
      u[i] *= kept;
      v[i] = v[i] * kept - 9.80665 * dt;
      w[i] *= kept;
      x[i] += u[i] * dt;
      y[i] += v[i] * dt;
      z[i] += w[i] * dt;
      if (y[i] < 0) {
        y[i] *= -0.5;
        if (v[i] < 0) v[i] *= -0.5;
      }
    }
    this.length = length;
  }
}

const capacity = Math.ceil(particles * 1.125) + 64;
const ours = new World(scene, undefined, capacity);
const byHand = new ByHand(capacity);
for (let i = 0; i < 360; i++) {
  ours.step(dt);
  byHand.step();
}
const least = [Infinity, Infinity];
for (let round = 0; round < rounds; round++) {
  for (const [number, [step, length]] of [
    [() => ours.step(dt), () => ours.positions().length / 3],
    [() => byHand.step(), () => byHand.length],
  ].entries()) {
    const start = performance.now();
    for (let i = 0; i < steps; i++) step();
    const taken = (1e6 * (performance.now() - start)) / (steps * length());
    least[number] = Math.min(least[number], taken);
  }
}
const [a, b] = least;
console.log(`${particles} particles: ours ${a.toFixed(2)} ns, by hand ${b.toFixed(2)} ns, ${(a / b).toFixed(2)} times`);
