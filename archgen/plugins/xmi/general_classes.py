"""The ways from classes up to what they are made from: where they end, and which are too long."""

from __future__ import annotations

from archgen.plugin.importing import XmlElement

MAX_GENERALS = 50
"""So many classes may stand one above another: the language reads 60 types, and a component is realized by one more."""


def find_top(tops: dict[XmlElement, XmlElement], element: XmlElement) -> XmlElement:
    """Return the class at the end of the way from each class to what it is made from; ways that were gone get shorter."""
    passed = []
    while element in tops:
        passed.append(element)
        element = tops[element]
    for each in passed:
        tops[each] = element
    return element


def list_beyond(generals: dict[XmlElement, XmlElement]) -> list[XmlElement]:
    """Return the classes whose way up is to be cut, so that none is longer than `MAX_GENERALS`."""
    beyond = []
    lengths: dict[XmlElement, int] = {}
    for start in generals:
        way = []
        current: XmlElement | None = start
        while current is not None and current not in lengths:
            way.append(current)
            current = generals.get(current)
        length = lengths[current] if current is not None else -1
        for each in reversed(way):
            length = length + 1
            if length > MAX_GENERALS:
                beyond.append(each)
                length = 0
            lengths[each] = length
    return beyond
