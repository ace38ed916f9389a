// Saves what a picture or the map shows: an SVG that stands alone, its colours and its font written into it, or a PNG of it.
"use strict";
globalThis.archgenSavePicture = (function () {
  const SHAPES = ["circle", "ellipse", "line", "path", "polygon", "polyline", "rect", "text", "tspan"];
  const PROPERTIES = ["fill", "fill-opacity", "stroke", "stroke-opacity", "stroke-width", "stroke-dasharray", "stroke-linecap", "opacity", "paint-order"];
  const TEXT_PROPERTIES = ["font-family", "font-size", "font-weight", "font-style", "text-anchor", "text-decoration-line"];
  const MAX_PIXELS = 16e6; // what browsers surely draw
  const SCALE = 2;
  const facesAddress = new URL("fonts.js", document.currentScript.src).href;

  function shape(name, attributes, ...children) {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.append(...children);
    return made;
  }

  // A copy with the colours as they are on the screen; what is not shown is left out.
  function copy(node) {
    if (node.nodeType !== Node.ELEMENT_NODE) return node.cloneNode();
    const style = getComputedStyle(node);
    if (style.display === "none" || style.visibility === "hidden" || node.classList.contains("hit")) return null;
    // Links lead to pages that are not there where the picture goes.
    const made = node.localName === "a" ? shape("g", {}) : node.cloneNode(false);
    for (const name of ["class", "role", "tabindex", "data-box", "data-arrow", "aria-label", "style"]) made.removeAttribute(name);
    if (SHAPES.includes(node.localName)) {
      const isText = node.localName === "text" || node.localName === "tspan";
      for (const name of isText ? [...PROPERTIES, ...TEXT_PROPERTIES] : PROPERTIES) made.setAttribute(name, style.getPropertyValue(name));
      // As wide as here: programs that know no fonts inside of pictures may lack this one.
      if (node.localName === "text" && node.textContent) {
        made.setAttribute("textLength", Math.round(node.getComputedTextLength() * 10) / 10);
        made.setAttribute("lengthAdjust", "spacingAndGlyphs");
      }
    }
    for (const child of node.childNodes) {
      const inner = copy(child);
      if (inner) made.append(inner);
    }
    return made;
  }

  function readFaces() {
    if (globalThis.archgenFaces) return Promise.resolve();
    return new Promise((done, failed) => {
      document.head.append(Object.assign(document.createElement("script"), { src: facesAddress, onload: done, onerror: failed }));
    });
  }

  // The faces that have any of the letters.
  function chooseFaces(text) {
    const codes = [...new Set(text)].map((letter) => letter.codePointAt(0));
    const holds = (range) => {
      const [first, last = first] = range.split("-").map((code) => parseInt(code, 16));
      return codes.some((code) => first <= code && code <= last);
    };
    return archgenFaces.filter(([ranges]) => ranges.some(holds)).map(([, face]) => face).join("");
  }

  async function makeSvg(layers, bounds, ground) {
    await readFaces();
    const [x, y] = [bounds.left, bounds.top];
    const width = Math.ceil(bounds.right - x), height = Math.ceil(bounds.bottom - y);
    const svg = shape("svg", { xmlns: "http://www.w3.org/2000/svg", width, height, viewBox: `${Math.floor(x)} ${Math.floor(y)} ${width} ${height}` },
      shape("rect", { x: Math.floor(x), y: Math.floor(y), width, height, fill: ground }), ...layers.map(copy).filter(Boolean));
    svg.prepend(shape("style", {}, chooseFaces(svg.textContent)));
    return { text: new XMLSerializer().serializeToString(svg), width, height };
  }

  function offer(href, name) {
    const link = Object.assign(document.createElement("a"), { href, download: name });
    document.body.append(link);
    link.click();
    link.remove();
  }

  return async function savePicture(layers, bounds, ground, name, format) {
    const { text, width, height } = await makeSvg(layers, bounds, ground);
    const address = "data:image/svg+xml;charset=utf-8," + encodeURIComponent(text);
    if (format === "svg") return offer(address, name + ".svg");
    const scale = Math.min(SCALE, Math.sqrt(MAX_PIXELS / (width * height)));
    const image = new Image();
    image.src = address;
    await image.decode();
    const canvas = Object.assign(document.createElement("canvas"), { width: Math.round(width * scale), height: Math.round(height * scale) });
    canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
    offer(canvas.toDataURL("image/png"), name + ".png");
  };
})();
