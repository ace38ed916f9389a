"""Names of ports that parameters hold: a filter whose `odom0` is `odom/unfiltered` reads that topic.

What an entry says in `named_by` and `when` becomes its topics, before endpoints are derived from them.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from archgen.diagnostics.source_span import Span
from archgen.frozen import dataclass
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
    connected_ports = {*(edge.input for edge in architecture.edges), *(edge.output for edge in architecture.edges)}
    for node in nodes.values():
        parameters = find_effective_parameters(architecture, node)
        reader = _NameReader(parameters, tuple(node.inner_nodes), is_complete=not node.unread_files)
        uses = tuple(named for use in node.uses for named in reader.name_use(use, connected_ports))
        nodes[node.id] = replace(node, uses=uses)
    return replace(architecture, nodes={**architecture.nodes, **nodes})


@dataclass(frozen=True, slots=True)
class _GivenNames:
    """The names that parameters give to a port, each with its place; `is_known` is whether these are all of them."""

    names: Sequence[tuple[str, Span]]
    is_known: bool
    is_open: bool


@dataclass(frozen=True, slots=True)
class _NameReader:
    """Reads the names of a node's ports. Of a node of which a parameter file cannot be read, none is surely unset."""

    parameters: Mapping[str, EffectiveParameter]
    inner_nodes: tuple[str, ...]
    is_complete: bool

    def name_use(self, use: PortUse, connected_ports: set[str]) -> Iterator[PortUse]:
        if use.named_by is None and not use.when:
            yield use
            return
        given = self._find_names(use)
        is_writing = use.use in {"publishes", "serves"}
        if not given.is_open:
            # A design that connects the port wants it: what it lacks is the parameter.
            yield use if use.port in connected_ports else replace(use, is_open=False)
        elif use.named_by is None:
            yield use
        elif use.topics:
            names = {name for name, _ in given.names}
            yield replace(use, own_name=names.pop() if len(names) == 1 else use.own_name)
        elif not given.is_known:
            yield replace(use, own_name=None)
        elif given.names and (is_writing or [name for name, _ in given.names] != [use.own_name]):
            # What somebody writes into a parameter is a decision; the program's own default gives way to a remap.
            names_by_place = dict(given.names)
            yield replace(
                use,
                topics=tuple(names_by_place),
                own_name=None,
                topic_places=tuple(names_by_place.values()),
            )
        else:
            yield use

    def _find_names(self, use: PortUse) -> _GivenNames:
        names: list[tuple[str, Span]] = []
        is_known, is_open = True, False
        is_writing = use.use in {"publishes", "serves"}
        is_inner = use.named_by is not None and use.named_by.partition(".")[0] in self.inner_nodes
        for prefix, word in self._list_bindings(use):
            holds = self._judge_conditions(use, prefix, word)
            if holds is False:
                continue
            is_known &= holds is not None
            parameter = self.parameters.get(_fill_in(use.named_by, prefix, word)) if use.named_by else None
            value = parameter.value if parameter else None
            if use.named_by is None or _SUBSTITUTION_MARK in word or (parameter and parameter.origin == "command"):
                is_known, is_open = False, True
            elif parameter and value not in (None, ""):
                values = value if isinstance(value, list | tuple) else [value]
                texts = [each for each in values if isinstance(each, str) and _SUBSTITUTION_MARK not in each]
                names += ((text, parameter.at) for text in texts)
                is_known, is_open = is_known and len(texts) == len(values), is_open or bool(values)
            elif default := use.own_name or word:
                names.append((default, use.at))
                is_open = True
            elif value is None and (is_writing or not self.is_complete):
                is_known, is_open = False, True  # what is written has a name without a parameter, too
        if not is_open and not self.is_complete:
            is_known, is_open = False, True
        # Where relative names of an inner node lead differs by version and program.
        is_known &= not is_inner or all(name.startswith("/") for name, _ in names)
        return _GivenNames(names, is_known, is_open)

    def _list_bindings(self, use: PortUse) -> Iterator[tuple[str, str]]:
        """Yield what stands for `*` and for the braces: each pair of which the parameters have something."""
        template = use.named_by or next(iter(use.when))
        braces = _LIST.search(template)
        source = template[: braces.start()] + braces[1] if braces else template
        prefixes = [""]
        if "*" in source:
            pattern = re.compile(re.escape(source).replace(r"\*", "(.+)", 1), re.DOTALL)
            prefixes = [match[1] for match in map(pattern.fullmatch, self.parameters) if match]
        for prefix in prefixes:
            if braces is None:
                yield prefix, ""
                continue
            listed = self.parameters.get(source.replace("*", prefix))
            value = listed.value if listed else None
            if listed and listed.origin == "command":
                value = _SUBSTITUTION_MARK
            for word in value.split() if isinstance(value, str) else value if isinstance(value, list | tuple) else ():
                yield prefix, str(word)

    def _judge_conditions(self, use: PortUse, prefix: str, word: str) -> bool | None:
        """Return whether the program has the port; None where a value is not known."""
        is_sure = True
        for template, wanted in use.when.items():
            parameter = self.parameters.get(_fill_in(template, prefix, word))
            is_set = parameter is not None and (parameter.value is not None or parameter.origin == "command")
            if is_set and (not parameter.is_known or _SUBSTITUTION_MARK in str(parameter.value)):
                is_sure = False
                continue
            if not is_set and not self.is_complete:
                is_sure = False
                continue
            value = format_parameter(parameter.value) if is_set else ""
            choices = wanted if isinstance(wanted, list | tuple) else [wanted]
            if value not in map(format_parameter, choices):
                return False
        return True if is_sure else None


def _fill_in(template: str, prefix: str, word: str) -> str:
    return _LIST.sub(lambda _: word, template).replace("*", prefix)
