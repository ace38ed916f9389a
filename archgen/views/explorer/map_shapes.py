"""The shape ExplorerMap: plain rows that the page of the explorer reads.

Rows refer to one another by their position in the other table. The page knows the order of the fields; it is written down
here, and in `assets/explorer/data.js`, which reads them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from archgen.diagnostics import Span
from archgen.frozen import dataclass, field
from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.component_nesting import list_surrounding
from archgen.timing.analysis import EventPace
from archgen.views.element_references import place_run
from archgen.views.explorer.column_layout import Path
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup
from archgen.views.search.search_entry import to_plain_text
from archgen.views.timing import value_format

Row = tuple[object, ...]
"""Texts, numbers and tuples of them."""
LINKED_TABLES = frozenset({"groups", "hosts", "components", "shells", "nodes", "topics", "chains", "requirements"})
"""Tables whose first field is an anchor: a site writes the address of its page there."""


@dataclass(frozen=True, slots=True)
class ExplorerMap:
    """The tables of an explorer, by name. Those of an element start with its anchor and its id.

    The places of nodes are those by group and by host; `written in` is file and line, with their address if they have one.

    | table | fields |
    |---|---|
    | `keys` | key, value: what selectors look for |
    | `names` | key, value, title: how people call a value |
    | `types` | name, message |
    | `groups` | anchor, id, title, owners, summary, place among components, place among nodes, written in |
    | `ways` | group, group, places of the lane in each column between them: the lines between groups, none where they are too many |
    | `hosts` | anchor, id, title, line, summary, place, written in |
    | `components` | anchor, id, title, group, line, summary, keys, period, progress, severity, place, written in |
    | `shells` | anchor, id, title, group, shell around, components directly inside, line, summary, keys, severity, place, written in |
    | `nodes` | anchor, id, title, components, group, host, line, summary, keys, period, severity, places, written in |
    | `topics` | anchor, name, flow, and the medium where it is no ROS |
    | `outputs` | component, name, type, note |
    | `inputs` | component, name, type, note, marks (1 optional, 2 joined by autoconnect) |
    | `rims` | shell, is it an output, name, type, note, marks, ports behind it, outputs that feed it: of composed components |
    | `flows` | style, input, outputs, and the medium where it is no ROS: between components |
    | `extra` | tail, head: what feeds a component of which no output is known yet |
    | `links` | tail, head, topic: between nodes |
    | `activities` | id, node, components; wait, response (ns) and reason as the first of a way |
    | `steps` | activity, activity, is it a call; link, wait, response (ns; null: unknown, in brackets: a part) and reason |
    | `chains` | anchor, id, title, status, words, components, nodes |
    | `requirements` | anchor, id, title, components |
    | `findings` | kind (0 component, 1 node, 2 shell), element, severity, message |
    """

    tables: Mapping[str, tuple[Row, ...]] = field(default_factory=dict)


_MAX_SUMMARY = 280
"""Letters of a description that the panel shows; the element's page has all of it."""


def list_path(architecture: Architecture, component: Component) -> Path:
    """Return what is around one of the architecture's `components` on the map, and itself."""
    # What is not designed yet of a composed one stands inside of its frame, under the same id.
    own_frame = (component.id,) if component.id in architecture.shells else ()
    return (component.group, *list_surrounding(architecture, component.id), *own_frame, component.id)


def list_passed_leaves(architecture: Architecture, kind: str, element_id: str) -> Iterable[str]:
    """Return what a chain passes that leads through an element: what gives an output, all that is inside of a component."""
    if kind == "output":
        return [port.rpartition(".")[0] for port in architecture.leaf_ports_of(kind, element_id)]
    return architecture.leaves_of(element_id)


def list_places(lookup: Lookup, span: Span) -> Row:
    """Return file and line of an element, with its address where a repository is configured; empty for no place."""
    place = place_run(lookup, span)
    return tuple(filter(None, (place.text, place.url))) if place else ()


def shorten_description(*texts: str | None) -> str:
    """Return the begin of a description, on one line."""
    text = to_plain_text(*texts)
    return text if len(text) <= _MAX_SUMMARY else f"{text[:_MAX_SUMMARY].rsplit(' ', 1)[0]} …"


def describe_paces(paces: Iterable[EventPace | None]) -> str:
    """Return a short line on how often something happens: `15 Hz, event`, `2 activities`."""
    words = dict.fromkeys(_describe_pace(pace) for pace in paces if pace)
    texts = [word.replace("<=", "≤").replace(">=", "≥") for word in words if word != "?"]
    return texts[0] if len(texts) == 1 else count_noun(len(texts), "rate") if texts else ""


def _describe_pace(pace: EventPace) -> str:
    """Return a rate without its period, and the behaviour: a box is narrow."""
    first_line, *more_lines = value_format.format_box_lines(pace)
    # A long figure takes two lines, the period being the second; what is not periodic says so on the last one.
    behaviour = more_lines[-1:] if pace.behaviour != "periodic" else ()
    return ", ".join((first_line.partition(" · ")[0], *behaviour))


def find_shortest_step(paces: Iterable[EventPace | None]) -> str:
    """Return the step of the period scale that is shortest, `unknown` where nothing is known."""
    order = list(value_format.PERIOD_STEP_WORDS)
    return min((value_format.find_period_step(pace) for pace in paces), key=order.index, default="unknown")
