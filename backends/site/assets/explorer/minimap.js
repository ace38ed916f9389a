// The whole of the map in small, with a frame where the window is; a click or a drag in it moves the window there.
"use strict";
archgenExplorer.makeMinimap = function (camera, stage) {
  const { shape } = archgenExplorer;
  const [WIDTH, HEIGHT] = [168, 112];
  const boxes = shape("g"), frame = shape("rect", { class: "window" });
  const svg = shape("svg", { class: "minimap floats", width: WIDTH, height: HEIGHT, "aria-hidden": "true" }, boxes, frame);
  let scale = 1, offset = [0, 0];

  function draw(scene, bounds) {
    const width = Math.max(1, bounds.right - bounds.left), height = Math.max(1, bounds.bottom - bounds.top);
    scale = Math.min((WIDTH - 12) / width, (HEIGHT - 12) / height);
    offset = [(WIDTH - width * scale) / 2 - bounds.left * scale, (HEIGHT - height * scale) / 2 - bounds.top * scale];
    const shown = scene.boxes.filter((box) => !box.hidden);
    boxes.replaceChildren(...shown.map((box) => shape("rect", { class: box.open ? "open" : box.picked || box.lit ? "lit" : "plain",
      x: box.x * scale + offset[0], y: box.y * scale + offset[1],
      width: Math.max(1.5, box.width * scale), height: Math.max(1.5, box.height * scale) })));
    follow(camera.view);
  }

  function follow(view) {
    const size = [stage.clientWidth / view.zoom, stage.clientHeight / view.zoom];
    frame.setAttribute("x", (-view.x / view.zoom) * scale + offset[0]);
    frame.setAttribute("y", (-view.y / view.zoom) * scale + offset[1]);
    frame.setAttribute("width", size[0] * scale);
    frame.setAttribute("height", size[1] * scale);
  }

  function go(event) {
    const box = svg.getBoundingClientRect();
    const x = (event.clientX - box.left - offset[0]) / scale, y = (event.clientY - box.top - offset[1]) / scale;
    const { view } = camera;
    camera.set(stage.clientWidth / 2 - x * view.zoom, stage.clientHeight / 2 - y * view.zoom, view.zoom);
  }
  svg.addEventListener("pointerdown", (event) => {
    svg.setPointerCapture(event.pointerId);
    go(event);
  });
  svg.addEventListener("pointermove", (event) => event.buttons && go(event));

  return { svg, draw, follow };
};
