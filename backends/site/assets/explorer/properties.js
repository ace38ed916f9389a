// Conditions on properties: `sil`, `sil>=2`, `vendor=ac*`. The same as archgen/model/property_conditions.py.
"use strict";
archgenExplorer.propertyConditions = (function () {
  const CONDITION = /^([a-z0-9_*]+)\s*(?:(>=|<=|=|>|<)\s*((?![<=>]).*\S))?$/;
  const FIGURE = /^([+-]?[0-9]+(?:\.[0-9]+)?)(?:\s*([^\s\d+.-]\S{0,30}))?$/;
  const DATE = /^\d{4}-(?:0[1-9]|1[0-2])-(?:0[1-9]|[12]\d|3[01])$/;
  const MAX_DIGITS = 15;
  const ORDERS = { ">=": (order) => order >= 0, "<=": (order) => order <= 0, ">": (order) => order > 0, "<": (order) => order < 0, "=": (order) => order === 0 };

  function readFigure(text) {
    const match = FIGURE.exec(text.trim());
    return match && match[1].replace(/\D/g, "").length <= MAX_DIGITS ? { value: Number(match[1]), unit: match[2] ?? "" } : null;
  }

  const sign = (first, second) => Number(first > second) - Number(first < second);

  function compare(text, other) {
    const [first, second] = [readFigure(text), readFigure(other)];
    if (first && second) return first.unit === second.unit ? sign(first.value, second.value) : null;
    if (DATE.test(text) && DATE.test(other)) return sign(text, other);
    return text === other ? 0 : null;
  }

  // A test of the texts `name=value` of an element, or null where the text is no condition.
  function read(text, fits) {
    const match = CONDITION.exec(text);
    if (!match) return null;
    const [, pattern, operator, wanted] = match;
    return (property) => {
      const at = property.indexOf("="), value = property.slice(at + 1);
      if (!fits(pattern, property.slice(0, at))) return false;
      if (!operator) return true;
      const order = compare(value, wanted);
      return order === null ? operator === "=" && fits(wanted, value) : ORDERS[operator](order);
    };
  }

  return { read };
})();
