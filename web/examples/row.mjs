// A thousand boxes in a row, and which of them a camera sees; by whichever form of the library it is given.
export function cullARow({ Culler, floats, World }) {
  const boxes = floats(6 * 1000); // in the module's memory: nothing is copied
  for (let i = 0; i < 1000; ++i) boxes.array.set([-1, -1, -2 - 4 * i, 1, 1, -1 - 4 * i], 6 * i);

  const world = new World();
  const handles = world.insert(boxes);
  const culler = new Culler();
  const near = 0.1, far = 10;
  const view = {
    worldToEye: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
    eyeToClip: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, far / (near - far), -1, 0, 0, (near * far) / (near - far), 0],
    width: 1280,
    height: 720,
  };
  const { ids } = culler.cull(world, view);
  console.log(`${ids.length} of ${handles.length} in view: ${[...ids].join(' ')}`);
}
