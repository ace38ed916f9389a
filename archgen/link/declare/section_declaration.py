"""Declare the sections of small elements: project, chains, views, review and so on.

Declare the variants as they are written; `link/variants` says how the project stands in them. Declare policies: flows
that the project forbids, sources that it asks for, and what it accepts all the same. Declare the agreements of
partners: terms in words, and what was signed.

Declare use cases: their actors, and the steps between these and the components.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping

from archgen.diagnostics import Diagnostic, Label, Severity, Span, did_you_mean
from archgen.frozen import replace
from archgen.link import mapping_values, sanity_checks
from archgen.link.declare.element_declaration import declare_element
from archgen.link.reference_resolution import ReferenceResolver
from archgen.link.value_readers import read_element, read_values
from archgen.model.agreed_terms import Agreement, Signature
from archgen.model.architecture import Chain, Policy, ProjectInfo, SourceDemand, UseCase, View, Waypoint
from archgen.model.path_resolver import ElementRef
from archgen.model.project_settings import (
    BREAK_CATEGORIES,
    AcceptedChange,
    AcceptedDifference,
    BreakPolicy,
    ConformSettings,
    GenerateSettings,
    ReviewSettings,
)
from archgen.model.source_repository import DEFAULT_BRANCH, SourceRepository
from archgen.model.use_case_steps import Actor, Step, StepEnd
from archgen.model.variant import BASE_NAME, Variant, WrittenChange
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlNode

_WAYPOINT_KINDS = ("node", "component", "output")


def declare_project(root: MappingNode, default_id: str, default_title: str) -> ProjectInfo:
    """Declare the project itself, with defaults for its id and title."""
    body = mapping_values.get_mapping(root, "project")
    values = {"id": default_id, "title": default_title, **read_values("project", ProjectInfo, body)}
    if entry := root.entries.get("project"):
        values["at"] = entry.key_span
    return ProjectInfo(**values)


def declare_chains(
    root: MappingNode,
    resolver: ReferenceResolver,
    implements: Mapping[str, Collection[str]],
    list_leaf_ports: Callable[[str, str], tuple[str, ...]],
) -> dict[str, Chain]:
    """Declare the chains; a waypoint that cannot be resolved is kept in `unresolved`: the chain then counts as open.

    `implements` holds the components of each node, `list_leaf_ports` returns what stands behind a port of a composed one.
    """
    chains_by_id: dict[str, Chain] = {}
    for name, entry, body in mapping_values.iterate_elements(root, "chains"):
        sanity_checks.report_empty_list(body, "through", "element", name, resolver.diagnostics)
        waypoints = [
            (resolver.resolve_reference(scalar, _WAYPOINT_KINDS, name, implements=implements), scalar)
            for scalar in mapping_values.get_scalars(body, "through")
        ]
        chains_by_id[name] = declare_element(
            "chain",
            Chain,
            entry,
            resolver,
            through=tuple(_make_waypoint(target, scalar, list_leaf_ports) for target, scalar in waypoints if target),
            unresolved=tuple(scalar.text for target, scalar in waypoints if target is None),
        )
    return chains_by_id


def _make_waypoint(
    target: ElementRef, scalar: ScalarNode, list_leaf_ports: Callable[[str, str], tuple[str, ...]]
) -> Waypoint:
    """Return an element of a chain; an output that passes on several is the composed component that it belongs to."""
    if target.kind == "output":
        leaf_ports = list_leaf_ports("output", target.id)
        if len(leaf_ports) > 1:
            return Waypoint("component", target.id.rpartition(".")[0], scalar.span)
        return Waypoint("output", leaf_ports[0], scalar.span)
    return Waypoint(target.kind, target.id, scalar.span)  # type: ignore[arg-type]


def declare_views(root: MappingNode, resolver: ReferenceResolver) -> dict[str, View]:
    """Declare the views, except one without `show`, which merging has reported."""
    return {
        name: declare_element("view", View, entry, resolver)
        for name, entry, body in mapping_values.iterate_elements(root, "views")
        if body.get("show") is not None
    }


def declare_repository(root: MappingNode) -> SourceRepository | None:
    """Declare where the files are on the web; None where the project does not say."""
    main_line = mapping_values.get_text(mapping_values.get_mapping(root, "review"), "main") or DEFAULT_BRANCH
    site = read_values("site", SourceRepository, mapping_values.get_mapping(root, "site"))
    return SourceRepository(**{"branch": main_line, **site}) if "address" in site else None


def declare_review(root: MappingNode) -> ReviewSettings:
    """Declare how changes are judged, without accepted changes that lack a reason, which merging has reported."""
    body = mapping_values.get_mapping(root, "review")
    return ReviewSettings(
        **read_values("review", ReviewSettings, body),
        breaking=_read_policy(body),
        guards_margins=mapping_values.get_mapping(body, "breaking").get("promise") is not None,
        accepted=tuple(
            AcceptedChange(
                entry.key, reason, mapping_values.get_text(item, "key"), item.span, mapping_values.get_text(item, "was")
            )
            for entry in mapping_values.get_mapping(body, "accepted")
            if isinstance(entry.value, SequenceNode)
            for item in entry.value.items
            if isinstance(item, MappingNode) and (reason := mapping_values.get_text(item, "reason"))
        ),
    )


def declare_conform(root: MappingNode) -> ConformSettings:
    """Declare how the project is held against a robot, without acceptances that lack something, which merging has reported."""
    body = mapping_values.get_mapping(root, "conform")
    return ConformSettings(
        **read_values("conform", ConformSettings, body),
        accepted=tuple(
            AcceptedDifference(entry.key, rules, reason, mapping_values.get_text(values, "until"), entry.key_span)
            for entry in mapping_values.get_mapping(body, "accepted")
            if (values := mapping_values.get_body(entry))
            and (rules := _read_rules(values))
            and (reason := mapping_values.get_text(values, "reason"))
        ),
    )


def declare_generate(root: MappingNode) -> GenerateSettings:
    """Declare which backends write the workspace of a project."""
    body = mapping_values.get_mapping(root, "generate")
    return GenerateSettings(
        into=mapping_values.get_text(body, "into"),
        backends={
            name: {
                option.key: option.value.text
                for option in options
                if isinstance(option.value, ScalarNode) and option.value.value is not None
            }
            for name, _, options in mapping_values.iterate_elements(body, "backends")
        },
    )


def _read_rules(acceptance: MappingNode) -> tuple[str, ...]:
    rule = mapping_values.get_text(acceptance, "rule")
    return mapping_values.get_texts(acceptance, "rule") if rule is None else (rule,)


def _read_policy(review: MappingNode) -> BreakPolicy | None:
    """Return how serious it is to break a partner: one severity for all categories, or one for each; None if not written."""
    text = mapping_values.get_text(review, "breaking")
    if text is not None:
        return BreakPolicy.from_severity(Severity(text))
    categories = mapping_values.get_mapping(review, "breaking")
    severities = {category: mapping_values.get_text(categories, category) for category in BREAK_CATEGORIES}
    written = {category: Severity(severity) for category, severity in severities.items() if severity is not None}
    return BreakPolicy(**written) if written else None


def declare_agreements(root: MappingNode, resolver: ReferenceResolver) -> dict[str, Agreement]:
    """Declare the agreements by id. One with nobody, with oneself, or that stands there in both orders is reported."""
    agreements: dict[str, Agreement] = {}
    for name, entry, body in mapping_values.iterate_elements(root, "agreements"):
        signed = body.entries.get("signed")
        agreement = Agreement(
            name,
            mapping_values.get_text_mapping(body, "terms"),
            _read_texts_by_name(mapping_values.get_mapping(body, "interfaces")),
            _read_signature(signed) if signed and isinstance(signed.value, MappingNode) else None,
            entry.key_span,
        )
        if fault := _find_fault(agreement, root, agreements, resolver):
            message, help_line = fault
            resolver.report("unknown-reference", message, entry.key_span, help_line=help_line, element=name)
        agreements[name] = agreement
        _report_unknown_outputs(mapping_values.get_mapping(body, "interfaces"), name, resolver)
    return agreements


def _find_fault(
    agreement: Agreement, root: MappingNode, agreements: dict[str, Agreement], resolver: ReferenceResolver
) -> tuple[str, str] | None:
    """Return what is wrong with the id of an agreement, and what to do about it."""
    partners = mapping_values.get_mapping(root, "partners").entries
    first, second = agreement.pair
    unknown = next((each for each in (first, second) if each not in partners and not resolver.is_lost(each)), None)
    if unknown:
        return f"there is no partner `{unknown}`", did_you_mean(unknown, partners) or "partners stand below `partners`"
    if first == second:
        return f"`{agreement.id}` names one partner twice", "an agreement is between two partners"
    if f"{second}-{first}" in agreements:
        return f"`{agreement.id}` is `{second}-{first}` the other way round", "write all of it below one of them"
    return None


def _read_signature(entry: MappingEntry) -> Signature:
    body = mapping_values.get_body(entry)
    versions = mapping_values.get_mapping(body, "versions")
    parts: list[tuple[tuple[str, ...], MappingNode]] = [((), body)]
    parts += [((giver.key,), mapping_values.get_body(giver)) for giver in versions]
    return Signature(
        **read_values("signature", Signature, body),
        by=mapping_values.get_text_mapping(body, "by"),
        versions=_read_texts_by_name(versions),
        at=entry.key_span,
        places={(*path, each.key): each.key_span for path, mapping in parts for each in mapping},
    )


def _read_texts_by_name(mapping: MappingNode) -> dict[str, dict[str, str]]:
    return {entry.key: dict(mapping_values.get_text_mapping(mapping, entry.key)) for entry in mapping}


def _report_unknown_outputs(interfaces: MappingNode, name: str, resolver: ReferenceResolver) -> None:
    """Report terms of outputs that there are not. Names of topics follow from the outputs: they are judged elsewhere."""
    for entry in interfaces:
        if entry.key.startswith("/") or entry.key in resolver.spans["output"] or resolver.is_lost(entry.key):
            continue
        guess = resolver.guesser.guess_name(entry.key, resolver.spans["output"])
        help_line = f"did you mean `{guess}`?" if guess else "name an output by its complete id, or a topic: `/tf`"
        message = f"no output named `{entry.key}`"
        resolver.report("unknown-reference", message, entry.key_span, help_line=help_line, element=name)


def declare_policies(root: MappingNode, resolver: ReferenceResolver) -> dict[str, Policy]:
    """Declare the policies, except one that says neither whole, which merging has reported."""
    policies_by_id: dict[str, Policy] = {}
    for name, entry, body in mapping_values.iterate_elements(root, "policies"):
        forbid = mapping_values.get_mapping(body, "forbid")
        has_flow = forbid.get("from") is not None and forbid.get("to") is not None
        demand = _declare_demand(mapping_values.get_mapping(body, "require"))
        if not has_flow and demand is None:
            continue
        accepted, places = _resolve_accepted(body, resolver, name)
        policies_by_id[name] = Policy(
            **read_element("policy", Policy, entry, body),
            forbid_from=(mapping_values.get_text(forbid, "from") or "") if has_flow else "",
            forbid_to=(mapping_values.get_text(forbid, "to") or "") if has_flow else "",
            require=demand,
            accepted=accepted,
            from_at=mapping_values.get_span(forbid, "from"),
            to_at=mapping_values.get_span(forbid, "to"),
            accepted_places=places,
        )
    return policies_by_id


def _declare_demand(body: MappingNode) -> SourceDemand | None:
    of, inputs_from = mapping_values.get_text(body, "of"), mapping_values.get_text(body, "inputs_from")
    if of is None or inputs_from is None:
        return None
    return SourceDemand(
        of,
        inputs_from,
        mapping_values.get_text(body, "guarded_by"),
        mapping_values.get_span(body, "of"),
        mapping_values.get_span(body, "inputs_from"),
    )


def _resolve_accepted(
    body: MappingNode, resolver: ReferenceResolver, policy_id: str
) -> tuple[dict[str, str], dict[str, Span]]:
    """Return the reasons by the complete ids of inputs, and where these are written."""
    reasons: dict[str, str] = {}
    places: dict[str, Span] = {}
    accepted = mapping_values.get_mapping(body, "accepted")
    for entry in accepted:
        reason = mapping_values.get_text(accepted, entry.key)
        target = resolver.resolve_reference(ScalarNode(entry.key, entry.key, entry.key_span), ("input",), policy_id)
        if target and reason is not None:
            reasons[target.id] = reason
            places[target.id] = entry.key_span
    return reasons, places


def declare_variants(root: MappingNode) -> dict[str, Variant]:
    """Declare the variants, except one that takes the name of the project itself, which is reported."""
    return {
        name: Variant(
            **read_element("variant", Variant, entry, body),
            changes=tuple(_list_changes(mapping_values.get_mapping(body, "changes"), "")),
        )
        for name, entry, body in mapping_values.iterate_elements(root, "variants")
        if name != BASE_NAME
    }


def _list_changes(node: YamlNode, path: str) -> Iterator[WrittenChange]:
    """Yield what stands below a node, leaf by leaf; lists are leaves, and so is what is known to be empty."""
    if isinstance(node, MappingNode) and node.entries:
        for entry in node:
            yield from _list_changes(entry.value, f"{path}.{entry.key}" if path else entry.key)
    elif path:
        yield WrittenChange(path, _write_leaf(node))


def _write_leaf(node: YamlNode) -> str:
    if isinstance(node, ScalarNode):
        return node.text
    if isinstance(node, MappingNode):
        return "{" + ", ".join(f"{entry.key}: {_write_leaf(entry.value)}" for entry in node) + "}"
    return "[" + ", ".join(_write_leaf(item) for item in node.items) + "]"


_END_KINDS = ("component", "output")


def declare_use_cases(root: MappingNode, resolver: ReferenceResolver) -> dict[str, UseCase]:
    """Declare the use cases."""
    use_cases: dict[str, UseCase] = {}
    for name, entry, body in mapping_values.iterate_elements(root, "use_cases"):
        values = read_element("use_case", UseCase, entry, body)
        steps = tuple(_declare_steps(body, values.get("actors", {}), name, resolver))
        use_cases[name] = UseCase(**values, steps=steps)
    return use_cases


def _declare_steps(
    body: MappingNode, actors: Mapping[str, Actor], use_case_id: str, resolver: ReferenceResolver
) -> Iterator[Step]:
    """Yield the steps, without those that lack an end, which merging has reported."""
    steps = body.get("steps")
    for item in steps.items if isinstance(steps, SequenceNode) else ():
        if not isinstance(item, MappingNode):
            continue
        source, target = mapping_values.get_scalar(item, "from"), mapping_values.get_scalar(item, "to")
        if source is not None and target is not None:
            yield Step(
                _resolve_end(source, actors, use_case_id, resolver),
                _resolve_end(target, actors, use_case_id, resolver),
                mapping_values.get_text(item, "say"),
                source.span,
            )


def _resolve_end(
    written_end: ScalarNode, actors: Mapping[str, Actor], use_case_id: str, resolver: ReferenceResolver
) -> StepEnd:
    """Return what an end of a step names: an actor of the use case wins over what the architecture has of that name."""
    text = written_end.text
    if text in actors:
        _warn_hidden(written_end, actors[text], use_case_id, resolver)
        return StepEnd("actor", text, written_end.span)
    guess = resolver.guesser.guess_name(text, actors) if "." not in text and not _is_known(text, resolver) else None
    if guess is not None:
        resolver.report(
            "unknown-reference",
            f"no actor, component or output named `{text}`",
            written_end.span,
            labels=(Label(actors[guess].at, "declared here"),),
            help_line=f"did you mean `{guess}`?",
            element=use_case_id,
        )
        return StepEnd("unknown", text, written_end.span)
    count = len(resolver.diagnostics)
    target = resolver.resolve_reference(written_end, _END_KINDS, use_case_id)
    if target is None:
        resolver.diagnostics[count:] = [_mention_actors(each, text, resolver) for each in resolver.diagnostics[count:]]
        return StepEnd("unknown", text, written_end.span)
    return StepEnd("output" if target.kind == "output" else "component", target.id, written_end.span)


def _is_known(text: str, resolver: ReferenceResolver) -> bool:
    return resolver.names.resolve_path(text, _END_KINDS).count > 0


def _warn_hidden(written_end: ScalarNode, actor: Actor, use_case_id: str, resolver: ReferenceResolver) -> None:
    """Warn where an actor has the name of a component: the actor is meant."""
    component_ids = resolver.names.ids_ending_in("component", actor.id)
    if component_ids:
        resolver.report(
            "hidden-reference",
            f"`{actor.id}` is the actor, which hides the component `{component_ids[0]}`",
            written_end.span,
            labels=(Label(actor.at, "the actor"), Label(resolver.spans["component"][component_ids[0]], "hidden")),
            help_line=f"write `{component_ids[0]}` if that is meant, or call the actor otherwise",
            element=use_case_id,
        )


def _mention_actors(diagnostic: Diagnostic, text: str, resolver: ReferenceResolver) -> Diagnostic:
    """Return a finding about an unknown name with what a step can name: a component, or an actor that is declared."""
    if diagnostic.rule != "unknown-reference":
        return diagnostic
    inputs = resolver.names.ids_ending_in("input", text)
    if inputs:
        component_id = inputs[0].rpartition(".")[0]
        return replace(diagnostic, help=f"a step ends at a component, whatever input it enters by: `{component_id}`")
    if diagnostic.help is not None or "." in text:
        return diagnostic
    return replace(diagnostic, help=f"who stands outside is declared in the use case: `actors: {{{text}: ...}}`")
