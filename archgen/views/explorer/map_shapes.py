"""The shape ExplorerMap: plain rows that the page of the explorer reads.

Rows refer to one another by their position in the other table. The page knows the order of the fields; it is written down
here, and in `assets/explorer/data.js`, which reads them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from archgen.frozen import dataclass

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
    | `chains` | anchor, id, title, status, words, components, nodes |
    | `requirements` | anchor, id, title, components |
    | `findings` | kind (0 component, 1 node, 2 shell), element, severity, message |
    """

    tables: Mapping[str, tuple[Row, ...]] = field(default_factory=dict)
