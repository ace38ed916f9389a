"""Prove that a refactoring changes names and places and nothing else, by comparing the models before and after it.

The pairs of ids are given, as a rename or a move has them: nothing is recognised by likeness.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping

from archgen.checking.reference_index import INNER_KINDS, Element, list_outer_ids
from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.change_listing import list_elements
from archgen.compare.kinds import ELEMENT_KINDS
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.normal_values import ElementTitle
from archgen.diagnostics import Diagnostic
from archgen.frozen import NamedTuple, dataclass
from archgen.grouping import group_pairs
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint
from archgen.model.selector_evaluation import SelectorEvaluator
from archgen.pipeline import CheckedProject


@dataclass(slots=True)
class RenamedIds:
    """Old and new ids of elements that change theirs, by kind: those of what they hold follow."""

    pairs: Mapping[Element, Element]

    @property
    def is_move(self) -> bool:
        """Whether elements come to stand in another group."""
        return any(old.rpartition(".")[0] != new.rpartition(".")[0] for (_, old), (_, new) in self.pairs.items())

    def map_element(self, element: Element) -> Element:
        """Return an element as it is called afterwards."""
        if element in self.pairs:
            return self.pairs[element]
        kind, element_id = element
        for outer_id in list_outer_ids(element_id):
            for outer_kind, inner_kinds in INNER_KINDS.items():
                stood = self.pairs.get((outer_kind, outer_id)) if kind in inner_kinds else None
                if stood is not None:
                    return kind, stood[1] + element_id[len(outer_id) :]
            # What stands inside of a type begins with the type's name between brackets.
            type_name = outer_id[1:-1] if outer_id[0] + outer_id[-1] == "<>" else ""
            new_type = self.map_id("component_type", type_name) if type_name else ""
            if new_type != type_name:
                return kind, f"<{new_type}>{element_id[len(outer_id) :]}"
        return element

    def map_id(self, kind: str, element_id: str) -> str:
        """Return the id that an element has afterwards."""
        return self.map_element((kind, element_id))[1]


def rename_last_word(elements: Iterable[Element], new_name: str, *, is_path: bool) -> RenamedIds:
    """Return the ids of elements whose last word is another now; of those that are no path, all is one word."""
    pairs = {}
    for kind, element_id in elements:
        outer = element_id.rpartition(".")[0] if is_path else ""
        pairs[kind, element_id] = (kind, f"{outer}.{new_name}" if outer else new_name)
    return RenamedIds(pairs)


_COMPARED_BY_EFFECT: Mapping[str, tuple[str, ...]] = {
    "view": ("show",),
    "policy": ("forbid", "require"),
    "variant": ("changes", "drop", "without"),
}
"""Keys of which not the text counts: what selectors select is compared, and the project in each variant."""


class ModelDifference(NamedTuple):
    """What differs between two models beside the ids that were meant to: elements with the keys that differ."""

    changes: tuple[str, ...]
    new_findings: tuple[Diagnostic, ...]


class WireNames(NamedTuple):
    """Names on the wire that follow from ids, before and after."""

    nodes: tuple[tuple[str, str], ...] = ()
    carriers: tuple[tuple[str, str], ...] = ()
    """Topics, services, actions and channels."""
    messages: tuple[tuple[str, str], ...] = ()


def compare_models(
    old: CheckedProject, new: CheckedProject, renamed: RenamedIds, kept_keys: frozenset[str] = frozenset()
) -> ModelDifference:
    """Compare two versions of a project, variants included, of which it is known which ids are which.

    `kept_keys` are the keys of nodes and their ports that are written out so that names on the wire stay.
    """
    versions = [(old, new)]
    changes: dict[str, None] = {}
    for name, variant in old.variants.items():
        stood = new.variants.get(renamed.map_id("variant", name))
        if stood is None:
            changes[f"the variant `{name}`"] = None
        else:
            versions.append((variant, stood))
    for before, after in versions:
        changes |= dict.fromkeys(_list_changes(before, after, renamed, kept_keys))
    # By rule: where a finding stands and how it is worded follows from names. That references lead where they did, and
    # that elements say what they said, is compared by itself.
    known_counts = Counter(finding.rule for finding in old.findings)
    new_findings = []
    for finding in new.findings:
        known_counts[finding.rule] -= 1
        if known_counts[finding.rule] < 0:
            new_findings.append(finding)
    return ModelDifference(tuple(changes), tuple(new_findings))


def find_followers(old: Architecture, new: Architecture, renamed: RenamedIds) -> WireNames:
    """Return the names on the wire that differ between two versions."""
    matched_ids = _match_ids(old, new, renamed)
    nodes: dict[str, str] = {}
    carriers: dict[str, str] = {}
    new_endpoints = _index_endpoints(new, RenamedIds({}))
    old_endpoints = _index_endpoints(old, renamed)
    for node in old.nodes.values():
        stood = new.nodes.get(matched_ids.common_id("node", node.id))
        if stood is None:
            continue
        if stood.full_name != node.full_name:
            nodes[node.full_name] = stood.full_name
        stood_endpoints = new_endpoints[stood.id]
        for place, endpoints in old_endpoints[node.id].items():
            for before, after in zip(endpoints, stood_endpoints.get(place, ()), strict=False):
                if before.name and after.name and before.name != after.name:
                    carriers[before.name] = after.name
    messages = matched_ids.new_ids.get("message", {})
    return WireNames(tuple(nodes.items()), tuple(carriers.items()), tuple(messages.items()))


_EndpointPlace = tuple[str, str, tuple[str, ...]]
"""How an endpoint is used, its port (of one without, its message), and the outputs that it hears."""


def _index_endpoints(
    architecture: Architecture, renamed: RenamedIds
) -> dict[str, dict[_EndpointPlace, list[Endpoint]]]:
    """Return the endpoints of each node by what they are, called as afterwards: in another file they have another order."""
    index: dict[str, dict[_EndpointPlace, list[Endpoint]]] = {node: {} for node in architecture.nodes}
    for each in architecture.list_endpoints():
        kind = "output" if each.use in {"publishes", "serves"} else "input"
        port = renamed.map_id(kind, each.port) if each.port else each.message or ""
        sources = tuple(sorted(renamed.map_id("output", source) for source in each.sources))
        index[each.node].setdefault((each.use, port, sources), []).append(each)
    return index


def _match_ids(old: Architecture, new: Architecture, renamed: RenamedIds) -> MatchedIds:
    matched_ids = MatchedIds()
    version = ArchitectureVersion(old)
    for kind, spec in ELEMENT_KINDS.items():
        own_kind = "component" if kind == "composed" else kind
        if kind == "project" or not spec.elements:
            continue
        for element_id in spec.elements(version):
            new_id = renamed.map_id(own_kind, element_id)
            if new_id != element_id or kind in {"component", "composed"}:
                matched_ids.add_pair(kind, element_id, new_id)
    if any(kind == "frame" for kind, _ in renamed.pairs) and len(old.frames) == len(new.frames):
        # What parameters make of a name, the order tells.
        for old_id, new_id in zip(old.frames, new.frames, strict=True):
            matched_ids.add_pair("frame", old_id, new_id)
    for old_id, new_id in _match_made_nodes(old, new, renamed):
        matched_ids.add_pair("node", old_id, new_id)
    for name, type_ in old.types.items():
        stood = new.types.get(renamed.map_id("type", name))
        if stood and type_.message and stood.message and type_.message != stood.message:
            matched_ids.add_pair("message", type_.message, stood.message)
    return matched_ids


def _match_made_nodes(old: Architecture, new: Architecture, renamed: RenamedIds) -> Iterator[tuple[str, str]]:
    """Yield the ids of nodes that follow from components, where these are called otherwise now."""
    new_nodes = group_pairs((tuple(node.implements), node.id) for node in new.nodes.values())
    for node in old.nodes.values():
        implemented = tuple(renamed.map_id("component", each) for each in node.implements)
        candidates = new_nodes.get(implemented, [])
        if node.id not in candidates and len(candidates) == 1:
            yield node.id, candidates[0]


def _list_changes(
    old: CheckedProject, new: CheckedProject, renamed: RenamedIds, kept_keys: frozenset[str]
) -> Iterator[str]:
    """Name the elements that say something else than before, and connections that came or went."""
    matched_ids = _match_ids(old.architecture, new.architecture, renamed)
    before, after = list_elements(
        ArchitectureVersion(old.architecture), ArchitectureVersion(new.architecture), matched_ids
    )
    fold = _Folder(renamed, matched_ids)
    for key in dict.fromkeys((*before, *after)):
        first, second = before.get(key), after.get(key)
        if first is None and key[0] == "port" and kept_keys:
            continue
        if first is None or second is None:
            yield f"{key[0].replace('_', ' ')} `{key[1]}` {'comes' if first is None else 'goes'}"
        elif first.values != second.values:
            was, is_now = fold.fold_values(first.values), fold.fold_values(second.values)
            keys = [
                name
                for name in dict.fromkeys((*was, *is_now))
                if was.get(name) != is_now.get(name)
                and name.partition("_")[0] not in _COMPARED_BY_EFFECT.get(key[0], ())
                and not (key[0] in {"node", "port"} and name in kept_keys)
                and not _are_same_titles(first.values.get(name), second.values.get(name))
            ]
            if keys:
                yield f"{key[0].replace('_', ' ')} `{second.own_id}` ({', '.join(keys)})"
    counts = [len(each.architecture.topics) + len(each.architecture.channels) for each in (old, new)]
    if counts[0] != counts[1] and not kept_keys:
        yield f"what passes on the wire: {counts[1]} names instead of {counts[0]}"
    selections = list_other_selections(old.architecture, new.architecture, renamed)
    yield from (each.text for each in selections if not (renamed.is_move and each.is_of_moved))
    old_edges, new_edges = ([(edge.output, edge.input) for edge in each.architecture.edges] for each in (old, new))
    expected = [
        (matched_ids.common_id("output", output), matched_ids.common_id("input", port)) for output, port in old_edges
    ]
    difference = Counter(expected)
    difference.subtract(new_edges)
    yield from (f"connection `{output}` -> `{port}`" for (output, port), count in difference.items() if count)


class _Folder:
    """Folds values so that both names of what is renamed are one: what follows a name differs in nothing else."""

    def __init__(self, renamed: RenamedIds, matched_ids: MatchedIds) -> None:
        words = {
            old_id.rpartition(".")[2]: new_id.rpartition(".")[2] for (_, old_id), (_, new_id) in renamed.pairs.items()
        }
        words |= {
            old_id: new_id
            for (_, old_id), (_, new_id) in renamed.pairs.items()
            if old_id.rpartition(".")[0] != new_id.rpartition(".")[0]
        }
        words |= matched_ids.new_ids.get("message", {})
        self._words = {old: new for old, new in words.items() if old != new}

    def fold_values(self, values: Mapping[str, object]) -> dict[str, object]:
        return {self._fold_text(key): self._fold(value) for key, value in values.items()}

    def _fold_text(self, text: str) -> str:
        for old, new in self._words.items():
            text = _replace_word(text, old, new) if old in text else text
        return text

    def _fold(self, value: object) -> object:
        if isinstance(value, str):
            return self._fold_text(value)
        if isinstance(value, frozenset):
            return frozenset(map(self._fold, value))
        if isinstance(value, Mapping):
            return tuple((self._fold(key), self._fold(each)) for key, each in value.items())
        return tuple(map(self._fold, value)) if isinstance(value, (tuple, list)) else value


def _replace_word(text: str, old: str, new: str) -> str:
    """Replace a word, or several with what is between them, where it is no part of a longer one."""
    pieces, begin = [], 0
    while (start := text.find(old, begin)) >= 0:
        end = start + len(old)
        is_whole = not any(each.isalnum() or each == "_" for each in (text[start - 1 : start], text[end : end + 1]))
        pieces += [text[begin:start], new if is_whole else old]
        begin = end
    return "".join((*pieces, text[begin:]))


def _are_same_titles(was: object, is_now: object) -> bool:
    """Whether titles are the same, or made of an id that is another one now."""
    if not (isinstance(was, ElementTitle) and isinstance(is_now, ElementTitle)):
        return False
    return was.text == is_now.text or (was.generated and is_now.generated)


class OtherSelection(NamedTuple):
    """What a selector selects otherwise; `is_of_moved`: only what is renamed or moved comes or goes."""

    text: str
    is_of_moved: bool


def list_other_selections(old: Architecture, new: Architecture, renamed: RenamedIds) -> Iterator[OtherSelection]:
    """Yield the selectors of views and policies that select something else, as patterns and names of groups do."""
    matched_ids = _match_ids(old, new, renamed)
    old_evaluator, new_evaluator = SelectorEvaluator(old), SelectorEvaluator(new)
    moved = {new_id for _, new_id in renamed.pairs.values()}
    own = {each for each in new.components if not moved.isdisjoint((each, *list_outer_ids(each)))}
    own |= {node.id for node in new.nodes.values() if own.intersection(node.implements)}
    for kind, selectors, new_selectors in (
        ("view", _list_shown(old), _list_shown(new)),
        ("policy", _list_judged(old), _list_judged(new)),
    ):
        for element_id, texts in selectors.items():
            new_texts = new_selectors.get(matched_ids.common_id(kind, element_id), ())
            for text, new_text in zip(texts, new_texts, strict=False):
                before, _ = old_evaluator.evaluate(text)
                after, _ = new_evaluator.evaluate(new_text)
                components = {matched_ids.common_id("component", each) for each in before.components}
                nodes = {matched_ids.common_id("node", each) for each in before.nodes}
                difference = (components ^ after.components) | (nodes ^ after.nodes)
                if difference:
                    what = f"what `{new_text}` selects in the {kind} `{element_id}`"
                    yield OtherSelection(what, difference <= own)


def _list_shown(architecture: Architecture) -> dict[str, tuple[str, ...]]:
    return {view.id: (view.show,) for view in architecture.views.values() if view.show}


def _list_judged(architecture: Architecture) -> dict[str, tuple[str, ...]]:
    return {
        policy.id: tuple(
            text
            for text in (
                policy.forbid_from,
                policy.forbid_to,
                *((policy.require.of, policy.require.inputs_from) if policy.require else ()),
            )
            if text
        )
        for policy in architecture.policies.values()
    }
