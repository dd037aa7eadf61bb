// A program against the package's types: it has to compile, and what is marked must not.
import init, { Files, World, version, type Particle } from "pointmass";

export async function main(draw: (positions: Float32Array, count: number) => void): Promise<string> {
  await init();
  const files = new Files();
  files.addText("part.scn", "particle 0 0 0  0 0 0  1");
  files.addMesh("nozzle", new Float32Array(9), new Uint32Array([0, 1, 2]));
  const worlds: World[] = [
    new World("particle 0 0 0"),
    new World({ particles: [] }, files),
    new World({}, null, 10, 7),
    new World({}, undefined, undefined, 7n),
  ];
  for (const world of worlds) {
    world.step(1 / 60);
    world.stepTo(1);
    const share: number = world.advance(1 / 60) + world.advance(world.dt, 4);
    const drop: Particle = { position: [0, 1, 0], radius: 0.1, color: [255, 0, 0, share > 1 ? 0 : 255] };
    const id: number | undefined = world.spawn(drop);
    const gone: boolean = id !== undefined && world.remove(id);
    if (gone) world.restart();
    const state: number = world.save();
    world.restore(state);
    if (world.forget(state)) world.listen();
    world.listen(0.5, 100);
    const [blows, struck]: [Float32Array, Uint32Array] = [world.blows(), world.struck()];
    draw(blows, struck.length + world.missedBlows);
    draw(world.positions(), world.count);
    draw(world.velocities(), world.capacity);
    draw(world.radii(), world.time);
    if (world.count > 5) draw(world.custom("heat"), world.count);
    const lists: Float32Array[] = [world.sprites([0, 1, 9]), world.sprites(new Float32Array(3), [0, 1, 0]), world.shapes(), world.boxes(), world.trails(), world.surfaces(), world.strands([0, 1, 9]), world.links(), world.links(0.5)];
    const [rows, materials]: [Uint32Array, Int32Array] = [world.points(), world.materials()];
    draw(new Float32Array(rows.length), materials.length);
    draw(world.springs(), lists.length + world.springs(0.5).length);
    const [colors, ids]: [Uint8Array, Uint32Array] = [world.colors(), world.ids()];
    // Copies are in memory that nobody else writes to, so that whatever takes no shared memory takes them; views need not be.
    const copies: Float32Array<ArrayBuffer>[] = [world.blows(), world.looks(), world.sprites([0, 1, 9]), world.shapes(), world.boxes(), world.surfaces(), world.strands([0, 1, 9]), world.springs(), world.links(), world.trails()];
    const words: Uint32Array<ArrayBuffer>[] = [world.ids(), world.points(), world.struck()];
    const others: [Uint8Array<ArrayBuffer>, Int32Array<ArrayBuffer>] = [world.colors(), world.materials()];
    draw(new Float32Array(copies.length + words.length), others.length);
    const said: string[] = [world.hash(), world.report(), ...world.warnings];
    draw(new Float32Array(colors.length + ids.length), said.length);
    world.free();
  }
  // @ts-expect-error: a number is no scene.
  new World(7);
  // @ts-expect-error: seconds are a number.
  worlds[0]?.step("1");
  // @ts-expect-error: a particle has no weight.
  worlds[0]?.spawn({ weight: 1 });
  // @ts-expect-error: a state is a number.
  worlds[0]?.restore("1");
  // @ts-expect-error: a capacity is a number.
  new World({}, files, "10");
  return version();
}
