"""Does each step of a use case run along a connection?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.common_wording import join_words
from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.diagnostics.suggestions import find_closest
from archgen.model.flow_graph import build_component_graph
from archgen.model.graph_search import find_reachable
from archgen.model.step_connections import StepConnections

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.model.architecture import Architecture, UseCase
    from archgen.model.flow_graph import FlowGraph
    from archgen.model.use_case_steps import Step, StepEnd

_MAX_BETWEEN = 3
"""So many components between two are named where a step leaves them out."""
_MAX_VISITS = 300_000
"""Components that are visited in one run to find what lies between: in a project of usual size for every step."""


def broken_step(architecture: Architecture) -> Iterator[Diagnostic]:
    """A step of a use case runs along no connection."""
    if not any(use_case.steps for use_case in architecture.use_cases.values()):
        return
    judge = _StepJudge(architecture)
    for use_case in architecture.use_cases.values():
        for number, step in enumerate(use_case.steps, 1):
            if judge.connections.needs_connection(step) and not judge.connections.find_connections(step):
                yield from judge.diagnose_step(use_case, number, step)


class _StepJudge:
    """Says what is wrong with steps without a connection; what that takes is computed once, and only if there is one."""

    def __init__(self, architecture: Architecture) -> None:
        self.architecture = architecture
        self.connections = StepConnections(architecture)
        self._open_components: frozenset[str] | None = None
        self._graph: FlowGraph | None = None
        self._visits_left = _MAX_VISITS

    def diagnose_step(self, use_case: UseCase, number: int, step: Step) -> Iterator[Diagnostic]:
        """Report a step that runs along no connection."""
        ends = [end for end in (step.source, step.target) if end.kind != "actor"]
        if any(self._is_open(end.participant) for end in ends):
            return
        fault, help_line = self._describe_fault(use_case, step)
        declared = (self.architecture.find_component(end.participant) for end in ends)
        yield Diagnostic(
            "broken-step",
            f"in the use case `{use_case.id}`, step {number} runs along no connection: {fault}",
            step.at,
            labels=tuple(Label(component.at, f"`{component.id}`") for component in declared if component),
            help=help_line,
            element=use_case.id,
        )

    def _is_open(self, component_id: str) -> bool:
        """Whether an input of a component has a source that is not resolved: that is reported, and may be what is missing."""
        if self._open_components is None:
            # What reads an input of the component around it has no connection of its own, and lacks none.
            handed_in = {port for ports in self.architecture.shell_ports.values() for port in ports}
            self._open_components = frozenset(
                port.component
                for port in self.architecture.inputs.values()
                if port.from_written and not port.connections and port.id not in handed_in
            )
        return bool(self._open_components) and not self._open_components.isdisjoint(
            self.architecture.leaves_of(component_id)
        )

    def _describe_fault(self, use_case: UseCase, step: Step) -> tuple[str, str]:
        source, target = step.source, step.target
        if source.kind == "actor":
            who = use_case.actors[source.id].title
            return (
                f"no input of `{target.participant}` is `external`, where something comes in from outside",
                f"write at the input that takes it who gives it: `{{external: {_shorten_sentence(who)}}}`, or lead the step to another component",
            )
        if target.kind == "actor":
            what = f"`{source.id}` is not" if source.kind == "output" else f"no output of `{source.id}` is"
            return (
                f"{what} `external`, and so goes to nobody outside",
                "write at the output who takes it: `{external: ...}`, or let another component begin the step",
            )
        if target.kind == "output":
            return (
                f"`{source.participant}` does not call `{target.id}`",
                f"a step leads to an output only where that is a service or action; else to its component, `{target.participant}`",
            )
        return f"nothing leads from `{source.id}` to `{target.id}`", self._suggest_connection(source, target)

    def _suggest_connection(self, source: StepEnd, target: StepEnd) -> str:
        """Return what can be done about two components between which nothing is connected."""
        connections, sender, reader = self.connections, source.participant, target.participant
        direct = [each.output for each in connections.list_between(sender, reader) if each.output]
        if source.kind == "output" and direct:
            return f"`{direct[0]}` does: name that, or `{sender}`"
        turned = [each.output for each in connections.list_between(reader, sender) if each.output]
        if turned:
            return f"`{turned[0]}` leads the other way: turn the step round, or write the connection that is missing"
        sent = connections.list_sent(sender)
        readers = (self.architecture.inputs[each.input].component for each in sent if each.input)
        guess = find_closest(reader, (name for name in readers if name != reader))
        if guess is not None:
            return f"did you mean `{guess}`?"
        between = self._find_between(sender, reader)
        if between:
            return f"it goes over {join_words([f'`{each}`' for each in between])}: write a step for each"
        output = source.id if source.kind == "output" else self._choose_output(sender)
        return f"connect them at `{reader}`: `inputs: {{INPUT: {output}}}`, or write the steps that lie between"

    def _choose_output(self, component_id: str) -> str:
        component = self.architecture.find_component(component_id)
        return next(
            (port.id for port in component.outputs.values()) if component else iter(()), f"{component_id}.OUTPUT"
        )

    def _find_between(self, sender: str, reader: str) -> tuple[str, ...]:
        """Return the components on a shortest way from one to the other; none if it is long, or there is none."""
        if self._visits_left <= 0:
            return ()
        self._graph = self._graph or build_component_graph(self.architecture)
        starts, goals = self.architecture.leaves_of(sender), frozenset(self.architecture.leaves_of(reader))
        # Backwards, so that each step of the way is one that comes nearer.
        distances = find_reachable(self._graph.predecessors, goals, _MAX_BETWEEN + 1)
        self._visits_left -= len(distances)
        place = min((start for start in starts if start in distances), key=distances.__getitem__, default=None)
        way: list[str] = []
        while place is not None and distances[place] > 1:
            nearer = distances[place] - 1
            place = next(each for each in self._graph.successors[place] if distances.get(each) == nearer)
            way.append(place)
        return tuple(way)


def _shorten_sentence(text: str) -> str:
    line = " ".join(text.split())
    return line if len(line) <= 40 else f"{line[:39]}…"  # noqa: PLR2004 - what an example line holds


RULES = ((broken_step, Severity.WARNING),)
