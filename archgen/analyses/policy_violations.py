"""Does data flow where the project forbids it, are milestones kept, and do selectors select something?"""

from __future__ import annotations

from collections.abc import Collection, Iterator

from archgen.diagnostics import Diagnostic, Label, Severity, Span, join_first
from archgen.frozen import NamedTuple
from archgen.model.architecture import Architecture, Policy, SourceDemand
from archgen.model.component import Connection, Input, Output
from archgen.model.selector_evaluation import SelectorEvaluator


class WrittenSelector(NamedTuple):
    """A selector written in the project: its view, milestone or policy (as a phrase, and by id), its text and its span."""

    owner_phrase: str
    element: str
    text: str
    span: Span


_last_evaluators: list[SelectorEvaluator] = []


def _share_evaluator(architecture: Architecture) -> SelectorEvaluator:
    """Return what evaluates selectors on an architecture, with look-ups that are made once for all rules below."""
    evaluator = next(iter(_last_evaluators), None)
    if evaluator is None or evaluator.architecture is not architecture:
        evaluator = SelectorEvaluator(architecture)
        _last_evaluators[:] = [evaluator]
    return evaluator


def _list_written_selectors(architecture: Architecture) -> Iterator[WrittenSelector]:
    """Yield all selectors of views, milestones and policies, except empty ones."""
    for view in architecture.views.values():
        if view.show:
            yield WrittenSelector(f"the view `{view.id}`", view.id, view.show, view.show_at)
    for milestone in architecture.milestones.values():
        if milestone.needs:
            yield WrittenSelector(f"the milestone `{milestone.id}`", milestone.id, milestone.needs, milestone.needs_at)
    for policy in architecture.policies.values():
        selectors = [(policy.forbid_from, policy.from_at), (policy.forbid_to, policy.to_at)]
        if policy.require:
            selectors += [
                (policy.require.of, policy.require.of_at),
                (policy.require.inputs_from, policy.require.from_at),
            ]
        for text, span in selectors:
            if text:
                yield WrittenSelector(f"the policy `{policy.id}`", policy.id, text, span)


def wrong_selector(architecture: Architecture) -> Iterator[Diagnostic]:
    """A selector in a view, milestone or policy cannot be read, or names what is not there."""
    evaluator = _share_evaluator(architecture)
    for written_selector in _list_written_selectors(architecture):
        for problem in evaluator.evaluate(written_selector.text)[1]:
            if problem.severity == "warning" and "finding:" in written_selector.text[problem.start : problem.end]:
                continue  # rules see no findings yet, so `finding:` selects nothing here
            if _may_be_unread(architecture, written_selector.text[problem.start : problem.end]):
                continue  # it may be declared in what could not be read, which is reported already
            yield Diagnostic(
                "wrong-selector",
                f"in the selector of {written_selector.owner_phrase}: {problem.message}",
                problem.locate(written_selector.text, written_selector.span),
                severity=Severity.WARNING if problem.severity == "warning" else None,
                help=problem.help,
                element=written_selector.element,
            )


def empty_view(architecture: Architecture) -> Iterator[Diagnostic]:
    """A view shows nothing, though all that its selector names is there."""
    evaluator = _share_evaluator(architecture)
    for view in architecture.views.values():
        if not view.show or not architecture.components:
            continue
        selection, problems = evaluator.evaluate(view.show)
        if not problems and not selection.components and not selection.nodes:
            yield Diagnostic(
                "empty-view",
                f"the view `{view.id}` shows nothing",
                view.show_at,
                help="see what a selector selects with `archgen list SELECTOR`",
                element=view.id,
            )


def missed_milestone(architecture: Architecture) -> Iterator[Diagnostic]:
    """The day of a milestone is over, and nodes that it needs are still planned."""
    day = architecture.commit_day
    for milestone in architecture.milestones.values():
        if day is None or milestone.date is None or not milestone.needs or milestone.date >= day:
            continue
        selection, _ = _share_evaluator(architecture).evaluate(milestone.needs)
        planned = [
            node
            for node in architecture.nodes.values()
            if node.status == "planned"
            and (node.id in selection.nodes or not selection.components.isdisjoint(node.implements))
        ]
        if planned:
            names = join_first([f"`{node.id}`" for node in planned])
            verb = "is" if len(planned) == 1 else "are"
            yield Diagnostic(
                "missed-milestone",
                f"the milestone `{milestone.id}` was on {milestone.date}, and {names} {verb} still planned: the newest commit is of {day}",
                milestone.at,
                help="say what is there by now (`status: existing` at the node), or move the day",
                element=milestone.id,
            )


def _may_be_unread(architecture: Architecture, path: str) -> bool:
    """Whether something that a path, key or pattern names may be in what could not be read."""
    # The last two parts of a path are the element's key and its parent's.
    return not architecture.unread_keys.isdisjoint(path.split(".")[-2:]) or (
        architecture.partial and ("*" in path or ":" in path)
    )


def find_forbidden_flows(
    architecture: Architecture, senders: Collection[str], receivers: Collection[str]
) -> Iterator[tuple[Connection, tuple[str, ...]]]:
    """Yield each connection that carries data directly from a sender to a receiver, with the outputs that do.

    Senders and receivers are complete ids of components. A service or action carries data both ways: from its client to
    its server, and back. What a component sends to itself does not count.
    """
    both_ways = {o.id for o in architecture.outputs.values() if architecture.flow_of(o) != "topic"}
    for connection in architecture.connections:
        reader = architecture.inputs[connection.input].component
        forbidden_outputs = []
        for output in connection.outputs:
            sender = architecture.outputs[output].component
            is_forward = sender in senders and reader in receivers
            is_backward = output in both_ways and reader in senders and sender in receivers
            if sender != reader and (is_forward or is_backward):
                forbidden_outputs.append(output)
        if forbidden_outputs:
            yield connection, tuple(forbidden_outputs)


def forbidden_flow(architecture: Architecture) -> Iterator[Diagnostic]:
    """Data flows directly between two parts of the robot that a policy keeps apart."""
    evaluator = _share_evaluator(architecture)
    for policy in architecture.policies.values():
        # A selector with an error selects nothing, and `wrong-selector` reports it.
        senders, _ = evaluator.evaluate(policy.forbid_from) if policy.forbid_from else (None, ())
        receivers, _ = evaluator.evaluate(policy.forbid_to) if policy.forbid_to else (None, ())
        accepted_inputs = _list_accepted_inputs(architecture, policy)
        if senders and receivers:
            for connection, outputs in find_forbidden_flows(architecture, senders.components, receivers.components):
                if connection.input in accepted_inputs:
                    continue
                yield _report_forbidden_flow(architecture, policy, connection, outputs)


def _report_forbidden_flow(
    architecture: Architecture, policy: Policy, connection: Connection, outputs: tuple[str, ...]
) -> Diagnostic:
    output_names = " and ".join(f"`{output}`" for output in outputs[:3])
    suffix = f" (and {len(outputs) - 3} more)" if len(outputs) > 3 else ""  # noqa: PLR2004 - three are named
    verb = "goes" if len(outputs) == 1 else "go"
    return Diagnostic(
        "forbidden-flow",
        f"{output_names}{suffix} {verb} to `{connection.input}`, which the policy `{policy.id}` forbids: {policy.title}",
        connection.at,
        labels=(Label(policy.at, "the policy"),),
        element=architecture.inputs[connection.input].component,
    )


def refused_source(architecture: Architecture) -> Iterator[Diagnostic]:
    """An element takes data from where a policy does not let it take any, and does not guard itself."""
    evaluator = _share_evaluator(architecture)
    for policy in architecture.policies.values():
        if policy.require is None:
            continue
        judged, judged_problems = evaluator.evaluate(policy.require.of)
        allowed, problems = evaluator.evaluate(policy.require.inputs_from)
        # A selector with an error selects nothing, and `wrong-selector` reports it.
        if any(problem.severity == "error" for problem in (*judged_problems, *problems)):
            continue
        accepted_inputs = _list_accepted_inputs(architecture, policy)
        for refused in _find_refused_sources(architecture, policy.require, judged.components, allowed.components):
            if refused.connection.input not in accepted_inputs:
                yield _report_refused_source(policy, policy.require, refused)


class _RefusedSource(NamedTuple):
    """An end of a connection that takes data, the port that it sends it from, and the connection."""

    taker: str
    source: str
    connection: Connection


def _find_refused_sources(
    architecture: Architecture, demand: SourceDemand, judged: Collection[str], allowed: Collection[str]
) -> Iterator[_RefusedSource]:
    both_ways = {o.id for o in architecture.outputs.values() if architecture.flow_of(o) != "topic"}
    for connection in architecture.connections:
        input_ = architecture.inputs[connection.input]
        for output_id in connection.outputs:
            output = architecture.outputs[output_id]
            if output.component == input_.component:
                continue
            if input_.component in judged and output.component not in allowed and not _is_guarded(input_, demand):
                yield _RefusedSource(input_.id, output_id, connection)
            is_asked = output_id in both_ways and output.component in judged
            if is_asked and input_.component not in allowed and not _is_guarded(output, demand):
                yield _RefusedSource(output_id, input_.id, connection)


def _is_guarded(port: Input | Output, demand: SourceDemand) -> bool:
    return demand.guarded_by is not None and port.annotations.properties.get(demand.guarded_by, "false") != "false"


def _list_accepted_inputs(architecture: Architecture, policy: Policy) -> frozenset[str]:
    """Return the inputs of leaves that a policy lets pass: also those behind a port of a composed component."""
    return frozenset(leaf for port in policy.accepted for leaf in architecture.leaf_ports_of("input", port))


def _report_refused_source(policy: Policy, demand: SourceDemand, refused: _RefusedSource) -> Diagnostic:
    guard = f", or say how it guards itself: `properties: {{{demand.guarded_by}: ...}}`" if demand.guarded_by else ""
    return Diagnostic(
        "refused-source",
        f"`{refused.taker}` takes data from `{refused.source}`, which the policy `{policy.id}` does not allow: {policy.title}",
        refused.connection.at,
        labels=(Label(policy.at, "the policy"),),
        help=f"take it from what `{' '.join(demand.inputs_from.split())}` selects{guard}",
        element=refused.taker.rpartition(".")[0],
    )


def unneeded_exception(architecture: Architecture) -> Iterator[Diagnostic]:
    """A policy accepts an input that it does not object to."""
    policies = [policy for policy in architecture.policies.values() if policy.accepted]
    evaluator = _share_evaluator(architecture)
    for policy in policies:
        if _has_wrong_selector(policy, evaluator):
            continue
        objected_inputs = set(_list_objected_inputs(architecture, policy, evaluator))
        for port, place in policy.accepted_places.items():
            if objected_inputs.isdisjoint(architecture.leaf_ports_of("input", port)):
                yield Diagnostic(
                    "unneeded-exception",
                    f"the policy `{policy.id}` does not object to `{port}`",
                    place,
                    help="take it out of `accepted`",
                    element=policy.id,
                )


def _has_wrong_selector(policy: Policy, evaluator: SelectorEvaluator) -> bool:
    """Whether a selector of a policy means nothing: then nobody knows to what it objects."""
    demand = policy.require
    texts = (policy.forbid_from, policy.forbid_to, *((demand.of, demand.inputs_from) if demand else ()))
    problems = (problem for text in texts if text for problem in evaluator.evaluate(text)[1])
    return any(problem.severity == "error" for problem in problems)


def _list_objected_inputs(architecture: Architecture, policy: Policy, evaluator: SelectorEvaluator) -> Iterator[str]:
    """Yield the inputs of the connections that a policy does not allow, accepted ones included."""
    if policy.forbid_from and policy.forbid_to:
        senders, receivers = (evaluator.evaluate(text)[0] for text in (policy.forbid_from, policy.forbid_to))
        flows = find_forbidden_flows(architecture, senders.components, receivers.components)
        yield from (connection.input for connection, _ in flows)
    if demand := policy.require:
        judged, allowed = (evaluator.evaluate(text)[0] for text in (demand.of, demand.inputs_from))
        refused_sources = _find_refused_sources(architecture, demand, judged.components, allowed.components)
        yield from (refused.connection.input for refused in refused_sources)


RULES = (
    (forbidden_flow, Severity.ERROR),
    (refused_source, Severity.ERROR),
    (unneeded_exception, Severity.NOTE),
    (wrong_selector, Severity.ERROR),
    (empty_view, Severity.WARNING),
    (missed_milestone, Severity.WARNING),
)
