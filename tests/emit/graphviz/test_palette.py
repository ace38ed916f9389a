"""Colours of partners: told apart on paper and in the dark, by the colour-blind too, and on no page another one than elsewhere."""

from __future__ import annotations

import re
from itertools import combinations
from pathlib import Path

import pytest

from archgen.emit.graphviz import palette
from archgen.model.architecture import Architecture
from archgen.syntax.yaml_parser import parse_yaml
from archgen.views.graphs.group_graphs import choose_partner_hues, draw_overview
from archgen.views.lookup import make_lookup
from tests.linking import link_table

_STYLE = Path(__file__).resolve().parents[3] / "backends" / "site" / "assets" / "explorer" / "explorer.css"
_SIGHTS = {
    "all colours": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    # Machado, Oliveira and Fernandes (2009), the whole deficiency, in linear light.
    "protan": ((0.152286, 1.052583, -0.204868), (0.114503, 0.786281, 0.099216), (-0.003882, -0.048116, 1.051998)),
    "deutan": ((0.367322, 0.860646, -0.227968), (0.280085, 0.672501, 0.047413), (-0.011820, 0.042940, 0.968881)),
    "tritan": ((1.255528, -0.076749, -0.178779), (-0.078411, 0.930809, 0.147602), (0.004733, 0.691367, 0.303900)),
}
_LUMINANCE = (0.2126, 0.7152, 0.0722)


def read_light(colour: str) -> list[float]:
    shares = [int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5)]
    return [share / 12.92 if share <= 0.04045 else ((share + 0.055) / 1.055) ** 2.4 for share in shares]


def see(colour: str, sight: str) -> tuple[float, float, float]:
    """Return the place of a colour in CIELAB, as somebody with this sight sees it."""
    light = [
        min(1.0, max(0.0, sum(a * b for a, b in zip(row, read_light(colour), strict=True)))) for row in _SIGHTS[sight]
    ]
    rows = ((0.4124, 0.3576, 0.1805), _LUMINANCE, (0.0193, 0.1192, 0.9505))
    x, y, z = (
        sum(a * b for a, b in zip(row, light, strict=True)) / white
        for row, white in zip(rows, (0.95047, 1.0, 1.08883), strict=True)
    )
    x, y, z = (part ** (1 / 3) if part > 0.008856 else 7.787 * part + 4 / 29 for part in (x, y, z))
    return 116 * y - 16, 500 * (x - y), 200 * (y - z)


def measure_contrast(one: str, other: str) -> float:
    low, high = sorted(
        sum(a * b for a, b in zip(_LUMINANCE, read_light(each), strict=True)) + 0.05 for each in (one, other)
    )
    return high / low


@pytest.mark.parametrize("sight", _SIGHTS)
@pytest.mark.parametrize("is_dark", [False, True])
def test_colours_of_partners_are_told_apart(sight: str, *, is_dark: bool) -> None:
    dark = dict(palette.dark_pairs())
    colours = [dark[each] if is_dark else each for each in palette.PARTNER_HUES]
    paper = dark[palette.PAPER] if is_dark else palette.PAPER
    assert min(measure_contrast(each, paper) for each in colours) >= 3
    seen = [see(each, sight) for each in colours]
    least = min(sum((a - b) ** 2 for a, b in zip(*pair, strict=True)) ** 0.5 for pair in combinations(seen, 2))
    assert least >= (20 if sight == "all colours" else 12)


def test_the_explorer_has_the_same_colours() -> None:
    pairs = re.findall(r"\.partner-(\d) \{ --hue: light-dark\((#\w+), (#\w+)\)", _STYLE.read_text(encoding="utf-8"))
    dark = dict(palette.dark_pairs())
    assert [(int(number), light) for number, light, _ in pairs] == list(enumerate(palette.PARTNER_HUES, 1))
    assert all(dark[light] == other for _, light, other in pairs)


def link_robot(partners: str, owners: str) -> Architecture:
    parts = ", ".join(f"c{at}: {{owner: {owner}}}" for at, owner in enumerate(owners))
    titles = ", ".join(f"{each}: {each.upper()}" for each in partners)
    text = f"partners: {{{titles}}}\ngroups: {{g: {{components: {{{parts}}}}}}}\n"
    document, _ = parse_yaml("archgen.yaml", text)
    assert document is not None
    return link_table(document.root)[0]


def test_a_partner_keeps_its_colour() -> None:
    hues = choose_partner_hues(make_lookup(link_robot("abc", "ab")))
    more = choose_partner_hues(make_lookup(link_robot("abcd", "abddddc")))
    assert hues == {"a": 1, "b": 2, "c": 3}
    assert more == {**hues, "d": 4}


def test_whoever_has_no_colour_is_grey_and_explained() -> None:
    many = "abcdefghijklm"
    graph = draw_overview(make_lookup(link_robot(many, many)))
    assert graph.legend_colours == (*((at, name.upper()) for at, name in enumerate(many[:9], 1)), (0, "others"))
    (box,) = graph.boxes
    assert box.members == (*((at, 1) for at in range(1, 10)), (None, 4))
    assert palette.partner_colour(None) == palette.partner_colour(0) == palette.FADED
