"""Architectures in a few lines, for tests of single rules: a shorthand that needs no reader and no linker.

Each line is one element, and its line number is its place:

    component GROUP.NAME [role=ROLE] [owner=ID] [functionality=TEXT] [requirements=ID,ID] [inputs] [outputs]
    in GROUP.NAME.PORT [from=REFERENCE,REFERENCE] [type=TYPE] [external] [physical] [optional]     (`from=?`: unresolved)
    out GROUP.NAME.PORT [type=TYPE] [external] [physical]
    type NAME MESSAGE [request=TYPE] [response=TYPE]
    node ID [implements=ID,ID] [name=NAME] [namespace=NAME] [planned] [timed=ID]
    use NODE publishes|subscribes|serves|calls KEY [port=ID] [topic=NAME] [message=NAME]
    end NODE publishes|subscribes|serves|calls TOPIC [port=ID] [internal] [written] [shared]
    suspect ID                                              (a reference that could not be resolved most likely meant it)
    requirement ID / partner ID / chain ID REFERENCE REFERENCE

A component counts as having known inputs (outputs) once it has one, or says `inputs` (`outputs`). References are complete.
"""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any

import pytest

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.source_span import Span
from archgen.model.architecture import Architecture, Chain, Partner, PortEdge, ProjectInfo, Waypoint
from archgen.model.component import Component, Connection, Group, Input, Output, RequirementUse
from archgen.model.declared_timing import Timing
from archgen.model.message_types import ConceptualType, flow_of
from archgen.model.node import Endpoint, Node, PortUse, Topic
from archgen.model.port_media import uses_ros
from archgen.model.requirement import Requirement

Words = dict[str, str]


def _read_medium(options: Words) -> str:
    return "physical" if "physical" in options else "ros"


@dataclass
class _Sketch:
    components: dict[str, dict[str, Any]] = field(default_factory=dict)
    inputs: dict[str, tuple[Words, Span]] = field(default_factory=dict)
    outputs: dict[str, Output] = field(default_factory=dict)
    types: dict[str, ConceptualType] = field(default_factory=dict)
    nodes: dict[str, Node] = field(default_factory=dict)
    ends: list[tuple[Endpoint, bool]] = field(default_factory=list)
    requirements: dict[str, Requirement] = field(default_factory=dict)
    partners: dict[str, Partner] = field(default_factory=dict)
    chains: dict[str, tuple[list[str], Span]] = field(default_factory=dict)
    suspects: set[str] = field(default_factory=set)

    def component(self, name: str, at: Span) -> dict[str, Any]:
        group, _, short = name.partition(".")
        known = {"id": name, "name": short, "group": group, "title": short, "at": at, "role_at": at}
        return self.components.setdefault(name, known)

    def read(self, number: int, line: str) -> None:
        kind, *words = shlex.split(line)
        options = {key: value for key, _, value in (word.partition("=") for word in words)}
        getattr(self, f"add_{kind}")(words, options, Span("a.yaml", number, 1, number, 2))

    def add_component(self, words: list[str], options: Words, at: Span) -> None:
        known = self.component(words[0], at)
        known |= {key: options[key] for key in ("role", "owner", "functionality") if key in options}
        known |= {f"{key}_known": True for key in ("inputs", "outputs") if key in options}
        if "requirements" in options:
            texts = filter(None, options["requirements"].split(","))
            known["requirements"] = tuple(RequirementUse(text, " " not in text, at) for text in texts)
            known["requirements_known"] = True

    def add_in(self, words: list[str], options: Words, at: Span) -> None:
        self.component(words[0].rpartition(".")[0], at)["inputs_known"] = True
        self.inputs[words[0]] = (options, at)

    def add_out(self, words: list[str], options: Words, at: Span) -> None:
        component, _, name = words[0].rpartition(".")
        self.component(component, at)["outputs_known"] = True
        external = "somebody" if "external" in options else None
        output = Output(
            words[0],
            name,
            component,
            options.get("type"),
            external,
            _read_medium(options),
            medium_written="physical" in options,
            at=at,
            type_at=at,
        )
        self.outputs[words[0]] = output

    def add_type(self, words: list[str], options: Words, at: Span) -> None:
        request, response = options.get("request"), options.get("response")
        self.types[words[0]] = ConceptualType(words[0], words[1], request=request, response=response, at=at)

    def add_node(self, words: list[str], options: Words, at: Span) -> None:
        implements = tuple(filter(None, options.get("implements", "").split(",")))
        self.nodes[words[0]] = Node(
            words[0],
            words[0],
            implements,
            name=options.get("name", words[0]),
            namespace=options.get("namespace", "/"),
            timing={options["timed"]: Timing()} if "timed" in options else {},
            written="planned" not in options,
            implements_written="implements" in options,
            at=at,
            name_at=at,
        )

    def add_use(self, words: list[str], options: Words, at: Span) -> None:
        node, use, key = words[:3]
        topics = tuple(filter(None, [options.get("topic")]))
        entry = PortUse(
            use,  # type: ignore[arg-type]
            key,
            options.get("port"),
            topics,
            message=options.get("message"),
            internal="port" not in options,
            at=at,
            topic_places=(at,) * len(topics),
        )
        self.nodes[node] = replace(self.nodes[node], uses=(*self.nodes[node].uses, entry))

    def add_end(self, words: list[str], options: Words, at: Span) -> None:
        node, use, name = words[:3]
        port = options.get("port")
        component = port.rpartition(".")[0] if port else None
        endpoint = Endpoint(
            node,
            use,  # type: ignore[arg-type]
            name,
            "topic" if use in {"publishes", "subscribes"} else "service",
            port,
            component,
            internal="internal" in options,
            written="written" in options,
            name_written="written" in options,
            at=at,
        )
        self.ends.append((endpoint, "shared" in options))

    def add_requirement(self, words: list[str], _: Words, at: Span) -> None:
        self.requirements[words[0]] = Requirement(words[0], words[0], at=at)

    def add_partner(self, words: list[str], _: Words, at: Span) -> None:
        self.partners[words[0]] = Partner(words[0], words[0], at=at)

    def add_suspect(self, words: list[str], _: Words, __: Span) -> None:
        self.suspects.add(words[0])

    def add_chain(self, words: list[str], _: Words, at: Span) -> None:
        self.chains[words[0]] = (words[1:], at)

    def carries(self, output: Output) -> bool:
        mapped = self.types.get(output.type or "")
        return uses_ros(output) and flow_of(mapped.message if mapped else None) == "topic"

    def connection(self, port: str, reference: str, at: Span) -> Connection:
        own = port.rpartition(".")[0]
        if reference in self.outputs:
            return Connection(port, reference, "output", reference, (reference,), at)
        below = (o for o in self.outputs.values() if o.id.startswith(f"{reference}.") and o.component != own)
        outputs = tuple(output.id for output in below if self.carries(output))
        return Connection(port, reference, "component" if "." in reference else "group", reference, outputs, at)

    def input(self, port: str, options: Words, at: Span) -> Input:
        component, _, name = port.rpartition(".")
        references = [r for r in options.get("from", "").split(",") if r and r != "?"]
        return Input(
            port,
            name,
            component,
            tuple(self.connection(port, reference, at) for reference in references),
            "somebody" if "external" in options else None,
            _read_medium(options),
            options.get("type"),
            "optional" in options,
            from_written="from" in options,
            medium_written="physical" in options,
            at=at,
            type_at=at,
        )

    def waypoint(self, text: str, at: Span) -> Waypoint:
        kind = "node" if text in self.nodes else "component" if text in self.components else "output"
        return Waypoint(kind, text, at)  # type: ignore[arg-type]

    def topics(self) -> Iterator[Topic]:
        for name in dict.fromkeys(end.label for end, _ in self.ends):
            here = [end for end, _ in self.ends if end.label == name]
            writers = tuple(end for end in here if end.use in {"publishes", "serves"})
            readers = tuple(end for end in here if end not in writers)
            shared = any(flag for end, flag in self.ends if end.label == name)
            yield Topic(name, here[0].flow, (), (), writers, readers, shared=shared)

    def finish(self) -> Architecture:
        inputs = {port: self.input(port, *rest) for port, rest in self.inputs.items()}
        components = {
            name: Component(
                **known,
                inputs={i.name: i for i in inputs.values() if i.component == name},
                outputs={o.name: o for o in self.outputs.values() if o.component == name},
            )
            for name, known in self.components.items()
        }
        names = dict.fromkeys(component.group for component in components.values())
        groups = {g: Group(g, g, components={c.name: c for c in components.values() if c.group == g}) for g in names}
        connections = tuple(connection for entry in inputs.values() for connection in entry.connections)
        return Architecture(
            ProjectInfo("p", "P"),
            partners=self.partners,
            requirements=self.requirements,
            groups=groups,
            components=components,
            inputs=inputs,
            outputs=self.outputs,
            connections=connections,
            edges=tuple(PortEdge(output, c.input, c.at) for c in connections for output in c.outputs),
            types=self.types,
            nodes=self.nodes,
            chains={
                name: Chain(name, name, tuple(self.waypoint(text, at) for text in through), at=at)
                for name, (through, at) in self.chains.items()
            },
            endpoints=tuple(end for end, _ in self.ends),
            suspected_ids=frozenset(self.suspects),
            topics={topic.name: topic for topic in self.topics()},
        )


def _sketch(text: str) -> Architecture:
    drawn = _Sketch()
    for number, line in enumerate(text.strip().splitlines(), 1):
        if line.strip():
            drawn.read(number, line)
    return drawn.finish()


@pytest.fixture
def sketch() -> Callable[[str], Architecture]:
    """Give the function that makes an architecture from the shorthand."""
    return _sketch


Judge = Callable[[Architecture], Iterable[Diagnostic]]


@pytest.fixture
def found() -> Callable[[Judge, str], list[str]]:
    """Give the function that runs a rule on a sketch: `line: message`, with `(severity)` where the rule chose one."""

    def run(judge: Judge, text: str) -> list[str]:
        return [
            f"{d.span.line}: {d.message}{f' ({d.severity})' if d.severity else ''}"
            for d in sorted(judge(_sketch(text)), key=lambda d: d.sort_key)
        ]

    return run
