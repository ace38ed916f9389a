"""Tell what was read of a model and not taken: properties, annexes, calls, and what counts in some modes alone."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.plugins.aadl.aadl_tree import AadlConnection, AadlFlow, AadlProperty, Classifier, Modes, Subcomponent
from archgen.plugins.aadl.classifier_names import ClassifierNames, KnownClassifier, fold_property_name
from archgen.plugins.aadl.import_notes import NoteList
from archgen.plugins.aadl.resolved_classifiers import ClassifierResolver

_TAKEN_PROPERTIES = frozenset(
    [
        *("dispatch_protocol", "period", "deadline", "dispatch_jitter", "compute_execution_time", "priority"),
        *("queue_size", "source_text", "source_name", "scheduling_protocol", "latency", "transmission_time"),
        *("actual_processor_binding", "actual_connection_binding", "data_size", "source_data_size"),
        *("topic_properties::name", "topic_properties::default_name"),
        *("sei::bandwidthcapacity", "bus_properties::bandwidth"),
        *(f"data_model::{name}" for name in ("data_representation", "enumerators", "element_names", "base_type")),
    ]
)
"""What is taken of some elements."""


def tell_untaken(resolver: ClassifierResolver) -> None:
    """Tell all that was left out."""
    names, notes = resolver.names, resolver.notes
    written_over = resolver.used | resolver.overridden
    known_sets = frozenset(names.property_sets)
    for known in names.known.values():
        classifier = known.classifier
        for name, span in classifier.annexes:
            notes.add_counted(f"annex {name}", "the text of annexes is not read", span)
        for association in _list_associations(classifier):
            if not known.is_of_library and id(association) not in written_over and not _is_computed(association, names):
                _tell_property(association, known_sets, notes)
            elif id(association) in resolver.used:
                _tell_values(association, notes)
        _tell_modes(known, notes)
        if classifier.calls and classifier.category != "subprogram":
            notes.add_counted("calls", "sequences of calls are not taken", classifier.span)
    for package in names.packages.values():
        for name, span in package.annexes:
            notes.add_counted(f"annex {name}", "the text of annexes is not read", span)
        for association in package.properties:
            _tell_property(association, known_sets, notes)


def _list_associations(classifier: Classifier) -> list[AadlProperty]:
    found = list(classifier.properties)
    elements = (classifier.features, classifier.subcomponents, classifier.connections, classifier.flows)
    for written in elements:
        found += [association for element in written for association in element.properties]
    return found


def _is_computed(association: AadlProperty, names: ClassifierNames) -> bool:
    """Whether a tool has computed a property: what archgen writes of flows and connections is, too."""
    name = fold_property_name(association.name)
    return name == "actual_latency" or (names.is_own and name == "latency")


def _tell_property(association: AadlProperty, known_sets: frozenset[str], notes: NoteList) -> None:
    name = fold_property_name(association.name)
    set_name = name.rpartition("::")[0]
    if set_name == "archgen":
        return
    words = "archgen has no word for this property"
    if name in _TAKEN_PROPERTIES:
        words = "it is not taken here: what it is said of is used nowhere, or has no word for it"
    elif set_name and set_name not in known_sets:
        words = f"the property set {set_name} is in none of the files, and archgen has no word for this property"
    notes.add_counted(f"property {association.name}", words, association.span)


def _tell_values(association: AadlProperty, notes: NoteList) -> None:
    """Tell a property that was taken as it is in some modes."""
    name, others = association.name, association.other_values
    if others:
        values = f"{len(others) + 1} values, each for other modes"
        words = f"{name} has {values}; the one of the initial mode counts, else that of no mode, else the first"
    elif association.modes:
        words = f"{name} has this value in {_name_modes(association.modes)}; here it counts always"
    else:
        return
    notes.add("in modes", words, association.span, fate="noted")


def _tell_modes(known_classifier: KnownClassifier, notes: NoteList) -> None:
    """Tell what stands in some modes alone, each at its place."""
    classifier = known_classifier.classifier
    if classifier.modes:
        words = "archgen has no modes: what changes when one follows another is not taken"
        notes.add_counted("modes", words, classifier.span)
    for element, kind in _list_elements(classifier):
        if element.modes:
            words = (
                f"{kind} {element.name}".strip() + f" is there in {_name_modes(element.modes)}; here it counts always"
            )
            notes.add("in modes", words, element.span, fate="noted")


def _list_elements(classifier: Classifier) -> Iterator[tuple[Subcomponent | AadlConnection | AadlFlow, str]]:
    yield from ((part, part.category) for part in classifier.subcomponents)
    yield from ((connection, "connection") for connection in classifier.connections)
    yield from ((flow, "flow") for flow in classifier.flows)


def _name_modes(modes: Modes) -> str:
    names = modes if len(modes) < 5 else (*modes[:3], f"{len(modes) - 3} others")  # noqa: PLR2004 - what reads well
    if len(names) == 1:
        return f"mode {names[0]} alone"
    return f"modes {', '.join(names[:-1])} and {names[-1]} alone"
