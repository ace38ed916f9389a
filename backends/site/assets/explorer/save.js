// Saves what the map shows as a picture: an SVG that stands alone, its colours written into it, or a PNG of it.
"use strict";
archgenExplorer.savePicture = (function () {
  const PROPERTIES = ["fill", "stroke", "stroke-width", "stroke-dasharray", "stroke-linecap", "font-size", "font-weight", "text-anchor"];
  const MARGIN = 24;
  const MAX_PIXELS = 16e6; // what browsers surely draw
  const SCALE = 2;

  // A copy with the colours as they are on the screen; what is not shown is left out.
  function copy(node) {
    if (node.nodeType !== Node.ELEMENT_NODE) return node.cloneNode();
    const style = getComputedStyle(node);
    if (style.display === "none" || style.visibility === "hidden" || node.classList.contains("hit")) return null;
    const made = node.cloneNode(false);
    for (const name of ["class", "role", "tabindex", "data-box", "data-arrow", "aria-label", "style"]) made.removeAttribute(name);
    if (["rect", "path", "text"].includes(node.localName)) {
      for (const name of PROPERTIES) made.setAttribute(name, style.getPropertyValue(name));
      // As wide as here: who opens it may lack the font.
      if (node.localName === "text" && node.textContent) {
        made.setAttribute("font-family", "Inter, Helvetica, Arial, sans-serif");
        made.setAttribute("textLength", Math.round(node.getComputedTextLength() * 10) / 10);
      }
    }
    for (const child of node.childNodes) {
      const inner = copy(child);
      if (inner) made.append(inner);
    }
    return made;
  }

  function makeSvg(layers, bounds, ground) {
    const { shape } = archgenExplorer;
    const [x, y] = [bounds.left - MARGIN, bounds.top - MARGIN];
    const width = Math.ceil(bounds.right - bounds.left + 2 * MARGIN), height = Math.ceil(bounds.bottom - bounds.top + 2 * MARGIN);
    const svg = shape("svg", { xmlns: "http://www.w3.org/2000/svg", width, height, viewBox: `${Math.floor(x)} ${Math.floor(y)} ${width} ${height}` },
      shape("rect", { x: Math.floor(x), y: Math.floor(y), width, height, fill: ground }), ...layers.map(copy).filter(Boolean));
    return { text: new XMLSerializer().serializeToString(svg), width, height };
  }

  function offer(href, name) {
    const link = archgenExplorer.element("a", { href, download: name });
    document.body.append(link);
    link.click();
    link.remove();
  }

  return async function savePicture(layers, bounds, ground, name, format) {
    const { text, width, height } = makeSvg(layers, bounds, ground);
    const address = "data:image/svg+xml;charset=utf-8," + encodeURIComponent(text);
    if (format === "svg") return offer(address, name + ".svg");
    const scale = Math.min(SCALE, Math.sqrt(MAX_PIXELS / (width * height)));
    const image = new Image();
    image.src = address;
    await image.decode();
    const canvas = archgenExplorer.element("canvas", { width: Math.round(width * scale), height: Math.round(height * scale) });
    canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
    offer(canvas.toDataURL("image/png"), name + ".png");
  };
})();
