"""The colours of pictures, each chosen and measured (WCAG) for light paper, with its counterpart in the dark.

Pictures are written in the light colours, so that a file looks the same in every viewer. Where a page embeds the svg,
`dark_rules` makes the style rules that replace each light colour by its dark one.
"""

from __future__ import annotations

TEXT = "#1b2127"
MUTED = "#55606a"
EDGE = "#66717a"
FRAME = "#3d4852"
SUBJECT = "#0072b2"
PAPER = "#ffffff"
NEIGHBOUR_FILL = "#eeeeee"
NEIGHBOUR_FRAME = "#8a8a8a"
GREY_TINT = "#f7f7f7"
TOPIC_FILL = "#fff6dc"
TOPIC_FRAME = "#a67c00"
SERVICE_FILL = "#efe6f7"
SERVICE_FRAME = "#6f4f9a"
NOTE = "#0b5a9c"
WARNING = "#8a5300"
ERROR = "#b3261e"
FADED = "#a3abb2"
FEEDBACK = "#b25e00"
"""Heads of arrows that run against the order of columns."""

HUES = ("#5b6770", "#0072b2", "#00795b", "#7a6a00", "#b04a00", "#a0407c", "#5b4fa8", "#8a3b3b", "#1b6e8c", "#6b5b3e")
"""Ten hues for groups, each with at least 5:1 on white. To the colour-blind some pairs look alike (simulated: 2 of 45
pairs for protan, 4 for deutan vision are nearer than CIE76 10), so a hue never says anything alone: the title is beside
it.
"""

_DARK_HUES = (
    *("#a9b4bd", "#5db2e8", "#4cc3a0", "#cdbb3f", "#f09a5c", "#e39ac6", "#b0a6f2", "#e59a9a", "#6fc3df", "#cbb68f"),
)

PARTNER_HUES = ("#219e8b", "#5e2206", "#4606c0", "#db514e", "#7e7bf8", "#b848a4", "#32761e", "#603868", "#ab2a54")
"""Nine fills for partners, the first ones the least alike; each with at least 3:1 on paper, and told apart by the colour-blind
(searched for and measured by CIEDE2000: at least 10 between any two for protan, deutan and tritan vision, 17 for others).
"""
_DARK_PARTNER_HUES = ("#68e3d1", "#f15f13", "#9ba4ed", "#aa666c", "#9366b1", "#e4c9fb", "#cdf8a0", "#c48eb0", "#ffa6a8")

INK = "#1b2126"
"""The text on a fill that is as light in the dark as on paper."""
RIM = "#3d4853"
"""The frame of such a fill: it does not change in the dark either."""
PERIODS = {
    "to_10_ms": "#08306b",
    "to_30_ms": "#08519c",
    "to_100_ms": "#2171b5",
    "to_300_ms": "#6baed6",
    "to_1_s": "#9ecae1",
    "slower": "#deebf7",
    "unknown": PAPER,
    "event": "#fde7c7",
    "on_demand": "#e9dff2",
    "once": "#e3e6e9",
}
"""Fills by period, each step lighter than the one before. The same in the dark, but for `unknown`."""
OK = "#1c6b3c"
CHANGES = {"added": OK, "removed": ERROR, "changed": WARNING, "renamed": NOTE}
"""Colours of what happened between two versions."""

_DARK_PAPER = "#14181c"
_DARK = {
    TEXT: "#e6eaee",
    MUTED: "#a7b1ba",
    EDGE: "#8e9aa5",
    FRAME: "#b8c2cb",
    PAPER: _DARK_PAPER,
    NEIGHBOUR_FILL: "#2a3138",
    NEIGHBOUR_FRAME: "#808a93",
    GREY_TINT: "#1a1f24",
    TOPIC_FILL: "#332b12",
    TOPIC_FRAME: "#d9b33f",
    SERVICE_FILL: "#2c2338",
    SERVICE_FRAME: "#bfa3e6",
    NOTE: "#7cc0f5",
    WARNING: "#f2b84b",
    ERROR: "#ff8a80",
    OK: "#6fd19a",
    FADED: "#5d6770",
    FEEDBACK: "#f2a65a",
}


def hue_colour(index: int | None) -> str:
    """Return the colour of a palette index; beyond ten they repeat."""
    return FRAME if index is None else HUES[index % len(HUES)]


def partner_colour(number: int | None) -> str:
    """Return the fill of a partner, counted from 1; grey for all who have none of their own."""
    return PARTNER_HUES[number - 1] if number else FADED


def mix_tint(colour: str, share: float = 0.08, paper: str = PAPER) -> str:
    """Return the paper's colour with a share of another colour mixed in."""
    pairs = ((int(colour[at : at + 2], 16), int(paper[at : at + 2], 16)) for at in (1, 3, 5))
    return "#" + "".join(f"{round(share * over + (1 - share) * under):02x}" for over, under in pairs)


def text_colour_on(fill: str) -> str:
    """Return white or dark, whichever reads better as text on a fill."""
    red, green, blue = (int(fill[at : at + 2], 16) for at in (1, 3, 5))
    # Perceived brightness (the weights of ITU-R BT.601), 0 to 255.
    if 0.299 * red + 0.587 * green + 0.114 * blue < 135:  # noqa: PLR2004
        return PAPER
    return INK if fill in _STEADY_FILLS else TEXT


def rim_colour_on(fill: str) -> str:
    """Return a frame colour that stands out from its fill and from the paper, in the light and in the dark."""
    return RIM if text_colour_on(fill) == INK else FRAME


_STEADY_FILLS = frozenset(PERIODS.values()) - {PAPER}


def dark_pairs() -> tuple[tuple[str, str], ...]:
    """Return pairs of each light colour and its dark counterpart."""
    hues = dict(zip(HUES, _DARK_HUES, strict=True))
    tints = {mix_tint(light): mix_tint(dark, 0.16, _DARK_PAPER) for light, dark in hues.items()}
    tints |= {mix_tint(light): mix_tint(_DARK[light], 0.16, _DARK_PAPER) for light in CHANGES.values()}
    partners = dict(zip(PARTNER_HUES, _DARK_PARTNER_HUES, strict=True))
    return tuple({**tints, **hues, **partners, **_DARK}.items())


def dark_rules(scope: str) -> str:
    """Return the CSS that turns embedded pictures dark. `scope` is a selector of what is round the svg elements."""
    rules = []
    for light, dark in dark_pairs():
        rules.append(f'{scope} svg.archgen :not(text)[fill="{light}"]{{fill:{dark}}}')
        # White is paper as a fill, but as a text it is on a dark fill that stays as it is: white text stays white.
        rules.append(f'{scope} svg.archgen text[fill="{light}"]{{fill:{dark if light != PAPER else light}}}')
        rules.append(f'{scope} svg.archgen [stroke="{light}"]{{stroke:{dark}}}')
    return "\n".join(rules) + "\n"
