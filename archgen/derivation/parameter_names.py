"""Names of ports that parameters hold: a filter whose `odom0` is `odom/unfiltered` reads that topic.

What an entry says in `named_by` and `when` becomes its topics, before endpoints are derived from them.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from archgen.diagnostics import Span
from archgen.frozen import dataclass, replace
from archgen.model.architecture import Architecture
from archgen.model.node import PortUse
from archgen.model.parameter import format_parameter
from archgen.model.parameter_values import EffectiveParameter, find_effective_parameters

_LIST = re.compile(r"\{([^{}]*)\}")
_SUBSTITUTION_MARK = "$("


def name_ports_by_parameters(architecture: Architecture) -> Architecture:
    """Return an architecture in which each port has the name that the parameters of its node give it."""
    nodes = {
        node.id: node
        for node in architecture.nodes.values()
        if any(use.named_by is not None or use.when for use in node.uses)
    }
    if not nodes:
        return architecture
    connected_ports = {port for edge in architecture.edges for port in (edge.input, edge.output)}
    for node in nodes.values():
        parameters = find_effective_parameters(architecture, node)
        reader = _NameReader(parameters, tuple(node.inner_nodes), is_complete=not node.unread_files)
        uses = (reader.name_use(use) if use.named_by is not None or use.when else use for use in node.uses)
        # A design that connects a port wants it, and lacks the parameter; a node that exists is as it is.
        wanted_ports = connected_ports if node.status != "existing" else set()
        opened_uses = (replace(use, is_open=use.is_open or use.port in wanted_ports) for use in uses)
        nodes[node.id] = replace(node, uses=tuple(opened_uses))
    return replace(architecture, nodes={**architecture.nodes, **nodes})


@dataclass(frozen=True, slots=True)
class _GivenNames:
    """The names that parameters give to a port, with their places; `is_known` is whether there can be no others."""

    names: Mapping[str, Span]
    is_known: bool
    is_open: bool


@dataclass(frozen=True, slots=True)
class _NameReader:
    """Reads the names of a node's ports. Of a node of which a parameter file cannot be read, none is surely unset."""

    parameters: Mapping[str, EffectiveParameter]
    inner_nodes: tuple[str, ...]
    is_complete: bool

    def name_use(self, use: PortUse) -> PortUse:
        given = self._find_names(use)
        if not given.is_open or use.named_by is None:
            return replace(use, is_open=given.is_open)
        if use.topics:  # what somebody writes is the name on the wire, and the parameter what the program says
            return replace(use, own_name=next(iter(given.names))) if len(given.names) == 1 else use
        if not given.is_known:
            return replace(use, own_name=None)
        # What somebody writes into a parameter is a decision; a reader's own default gives way to its source's name.
        if _is_writing(use) or [*given.names] != [use.own_name]:
            return replace(use, topics=(*given.names,), own_name=None, topic_places=(*given.names.values(),))
        return use

    def _find_names(self, use: PortUse) -> _GivenNames:
        names: dict[str, Span] = {}
        is_known, is_open = True, False
        template = use.named_by or next(iter(use.when))
        for prefix, word in self._list_bindings(use):
            holds = self._judge_conditions(use, prefix, word)
            if holds is False:
                if not _LIST.search(template) and "*" not in template:
                    return _GivenNames({}, is_known=True, is_open=False)
                continue
            is_known &= holds is not None
            parameter = self.parameters.get(_fill_in(use.named_by, prefix, word)) if use.named_by else None
            value = parameter.value if parameter else None
            if use.named_by is None or _SUBSTITUTION_MARK in word or (parameter and parameter.origin == "command"):
                is_known, is_open = False, True
            elif parameter and value is not None and value != "":
                given = _list_values(value)
                texts = [each for each in given if isinstance(each, str) and _SUBSTITUTION_MARK not in each]
                names |= dict.fromkeys(texts, parameter.at)
                is_known, is_open = is_known and len(texts) == len(given), is_open or bool(given)
            elif default := use.own_name or word:
                names[default], is_open = use.at, True
            elif value is None and (_is_writing(use) or not self.is_complete):
                is_known, is_open = False, True  # what is written has a name without a parameter, too
        if not is_open and not self.is_complete:
            is_known, is_open = False, True
        if use.named_by is not None and use.named_by.partition(".")[0] in self.inner_nodes:
            # Where relative names of an inner node lead differs by version and program.
            is_known &= all(name.startswith("/") for name in names)
        return _GivenNames(names, is_known, is_open)

    def _list_bindings(self, use: PortUse) -> Iterator[tuple[str, str]]:
        """Yield what stands for `*` and for the braces: each pair of which the parameters have something."""
        template = use.named_by or next(iter(use.when))
        braces = _LIST.search(template)
        source = template[: braces.start()] + braces[1] if braces else template
        pattern = re.compile(re.escape(source).replace(r"\*", "(.+)", 1), re.DOTALL)
        matches = filter(None, map(pattern.fullmatch, self.parameters))
        for prefix in [match[1] for match in matches] if "*" in source else [""]:
            listed = self.parameters.get(source.replace("*", prefix)) if braces else None
            value = _SUBSTITUTION_MARK if listed and listed.origin == "command" else listed.value if listed else None
            words = value.split() if isinstance(value, str) else _list_values(value) if braces else [""]
            yield from ((prefix, str(word)) for word in words if word is not None)

    def _judge_conditions(self, use: PortUse, prefix: str, word: str) -> bool | None:
        """Return whether the program has the port; None where a value is not known."""
        is_sure = True
        for template, wanted in use.when.items():
            parameter = self.parameters.get(_fill_in(template, prefix, word))
            value = parameter.value if parameter else None
            is_set = value is not None or bool(parameter and parameter.origin == "command")
            if not is_set and self.is_complete:
                text = ""
            elif value is None or _SUBSTITUTION_MARK in str(value):
                is_sure = False
                continue
            else:
                text = format_parameter(value)
            if text not in map(format_parameter, _list_values(wanted)):
                return False
        return True if is_sure else None


def _fill_in(template: str, prefix: str, word: str) -> str:
    return _LIST.sub(lambda _: word, template).replace("*", prefix)


def _is_writing(use: PortUse) -> bool:
    return use.use in {"publishes", "serves"}


def _list_values(value: object) -> list[object]:
    return list(value) if isinstance(value, list | tuple) else [value]
