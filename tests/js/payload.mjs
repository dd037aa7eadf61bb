// The part that is run in every JavaScript engine: computes only, so that a page can import it as well as Node.
// `pointmass` is the package, initialised; `scenes` the texts of the hash scenes by name, `meshes` those
// that they name.
export function run(pointmass, scenes, meshes) {
  const { World, Files, version } = pointmass;
  const files = new Files();
  for (const [name, { corners, triangles }] of Object.entries(meshes)) {
    files.addMesh(name, new Float32Array(corners), new Uint32Array(triangles));
  }
  const hashes = {};
  for (const [name, text] of Object.entries(scenes)) {
    const declared = text.startsWith("{");
    const world = new World(text, declared ? files : undefined, declared ? undefined : 40);
    const frames = declared ? Number(name.split("/")[2] ?? 30) : 600;
    for (let frame = 1; frame <= frames; frame++) world.stepTo(frame / 60);
    hashes[name] = world.hash();
    world.free();
  }

  // A world whose memory never moves: the view taken first shows the last step too.
  const fountain = new World(JSON.stringify({
    run: { capacity: 100, integrator: "symplectic" },
    forces: [{ gravity: { acceleration: [0, -9.8, 0] } }],
    emitters: [{ shape: { mesh: "nozzle" }, rate: 50, speed: 5, lifetime: 1 }],
  }), nozzle(Files), 100, 7n);
  fountain.step(1 / 60);
  fountain.step(1 / 60);
  const first = fountain.positions();
  for (let frame = 0; frame < 300; frame++) fountain.step(1 / 60);
  const now = fountain.positions();
  const result = {
    version: version(),
    hashes,
    fountain: {
      count: fountain.count,
      capacity: fountain.capacity,
      time: fountain.time,
      length: now.length,
      sameMemory: first.buffer === now.buffer && first[0] === now[0] && first[2] === now[2],
      finite: now.subarray(0, 3 * fountain.count).every(Number.isFinite),
      ids: new Set(fountain.ids()).size,
      colors: fountain.colors().length,
      speeds: fountain.velocities().length,
      report: JSON.parse(fountain.report()),
    },
    balls: balls(World),
    error: message(() => new World("particle 0 0 0\n  1 x")),
    missing: message(() => new World("mesh -1 bunny.off")),
  };
  fountain.free();
  return result;
}

// Two that meet, and a point.
function balls(World) {
  const world = new World(JSON.stringify({
    contacts: { impulse: {} },
    particles: [
      { position: [-1, 0, 0], velocity: [1, 0, 0], radius: 0.25, elasticity: 1 },
      { position: [1, 0, 0], radius: 0.5, elasticity: 1 },
      { position: [0, 9, 0] },
    ],
  }));
  world.stepTo(2);
  const result = { radii: [...world.radii()].slice(0, world.count), speeds: [...world.velocities()].slice(0, 3 * world.count), report: JSON.parse(world.report()) };
  world.free();
  return result;
}

function nozzle(Files) {
  const files = new Files();
  files.addMesh("nozzle", new Float32Array([0, 0, 0, 0, 0, 1, 1, 0, 0]), new Uint32Array([0, 1, 2]));
  return files;
}

function message(action) {
  try {
    action();
    return "no error";
  } catch (error) {
    return error.message;
  }
}
