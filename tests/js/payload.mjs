// What is run in every JavaScript engine: computes only, so that a page can import it as well as Node.
// `pointmass` is the package, initialised.
export function run(pointmass) {
  return {
    version: pointmass.version(),
    // PLACEHOLDER: name -> hash (16 hexadecimal digits) of the scenes in tests/hashes.txt.
    hashes: {},
  };
}
