"""Changes as a reviewer counts them: what one edit brought about is one item, told in one sentence.

The changes themselves stay as they are: programs read them, and what is accepted names them.

Files that a project no longer reads though they are still there: one edit of `archgen.yaml` takes all in them away.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Literal

from archgen.compare.change_sentences import SURE_CONFIDENCE, note_confidence
from archgen.compare.comparison import Change, ChangeKind, Comparison, PartnerBreak
from archgen.compare.key_phrases import compare_field_lines, tick_names
from archgen.compare.kinds import ELEMENT_KINDS
from archgen.compare.reshaping import find_reshapings
from archgen.compare.type_edits import find_type_edits
from archgen.diagnostics import join_words, keep_first, order_naturally
from archgen.frozen import dataclass
from archgen.model.project_settings import BREAK_CATEGORIES, BreakCategory

_MAX_FILES = 4
"""How many files one sentence names; the rest is counted."""
_INTERFACE_ENDINGS = (".msg", ".srv", ".action")


@dataclass(frozen=True, slots=True)
class LeftOutFiles:
    """What a setting no longer names: the sentence about it, and the removals that follow from it."""

    text: str
    removals: tuple[Change, ...]


def find_left_out(comparison: Comparison, changes: Sequence[Change]) -> Iterator[LeftOutFiles]:
    """Yield for each setting what it left out; nothing where only a file was left out from which nothing is gone."""
    elements = comparison.versions.elements_before.values()
    file_of_element = {(element.kind, element.own_id): element.file for element in elements}
    for setting in ("sources", "ros.interfaces"):
        files = [
            file
            for file in comparison.left_out_files
            if ("ros.interfaces" if file.endswith(_INTERFACE_ENDINGS) else "sources") == setting
        ]
        removals = tuple(
            change
            for change in changes
            if change.kind == "removed"
            and (
                file_of_element.get((change.element_kind, change.element_id)) in files
                or (
                    change.element_kind == "message"
                    and any(_defines_message(file, change.element_id) for file in files)
                )
            )
        )
        if removals:
            counts = _count_elements(removals)
            is_one = len(removals) == 1
            text = f"`{setting}` no longer names {tick_names(files, _MAX_FILES)}: {counts} {'is' if is_one else 'are'} not read any more"
            yield LeftOutFiles(text, removals)


def _defines_message(file: str, message: str) -> bool:
    """Whether a file is that of a message `package/msg/Name`: the package may be named elsewhere."""
    stem, _, ending = file.rpartition(".")
    return message.split("/")[1:] == [ending, stem.rpartition("/")[2]]


def _count_elements(removals: Iterable[Change]) -> str:
    """Count what is not read any more: `6 nodes and 1 chain`."""
    kinds = Counter(change.element_kind for change in removals)
    phrases = [f"{count} {ELEMENT_KINDS[kind].element_word}{'s' if count > 1 else ''}" for kind, count in kinds.items()]
    return join_words(phrases)


def find_affected_names(comparison: Comparison, removals: Iterable[Change]) -> frozenset[str]:
    """Return the ids of what is not read any more, and of the components that it was for."""
    removed_keys = {(change.element_kind, change.element_id) for change in removals}
    names = {name for _, name in removed_keys}
    for element in comparison.versions.elements_before.values():
        if (element.kind, element.own_id) in removed_keys:
            names.update(element.component_refs)
    return frozenset(names)


EditKind = Literal[ChangeKind, "split", "merged", "copied"]
_MAX_PAIRS = 6
"""How many old and new ids one sentence names."""
_MAX_INSTANCES = 3


@dataclass(frozen=True, slots=True)
class Edit:
    """One edit with all changes that it brought about, and the element that it is shown with."""

    kind: EditKind
    element_kind: str
    element_id: str
    text: str
    changes: tuple[Change, ...]
    confidence: float = 1.0
    """How sure it is that the changes are one edit."""
    related_ids: tuple[str, ...] = ()
    """What a component was split into, what was merged into it (or a group), or what it is a copy of."""

    @property
    def breaks(self) -> tuple[PartnerBreak, ...]:
        """Return the losses of partners, each once."""
        return tuple(dict.fromkeys(each for change in self.changes for each in change.breaks))

    @property
    def broken_partners(self) -> tuple[str, ...]:
        """Return the partners who lose something, sorted."""
        return tuple(sorted({each.partner for each in self.breaks}, key=order_naturally))

    @property
    def break_categories(self) -> tuple[BreakCategory, ...]:
        """Return the categories of what partners lose, in the order of the policy."""
        categories = {each.category for each in self.breaks}
        return tuple(category for category in BREAK_CATEGORIES if category in categories)


def list_edits(comparison: Comparison) -> tuple[Edit, ...]:
    """Return the edits behind the changes of a comparison, in the order of the first change of each."""
    positions = {id(change): position for position, change in enumerate(comparison.changes)}
    # What is told about a variant alone is no part of an edit of the project itself.
    left_changes = [change for change in comparison.changes if not change.variants]
    edits: list[Edit] = []
    for edit in _find_joint_edits(comparison, left_changes):
        edits.append(edit)
        folded_ids = set(map(id, edit.changes))
        left_changes[:] = (change for change in left_changes if id(change) not in folded_ids)
    edits += (
        Edit(change.kind, change.element_kind, change.element_id, change.text, (change,), change.confidence)
        for change in (*left_changes, *(each for each in comparison.changes if each.variants))
    )
    return tuple(sorted(edits, key=lambda edit: min(positions[id(change)] for change in edit.changes)))


def _find_joint_edits(comparison: Comparison, left_changes: Sequence[Change]) -> Iterator[Edit]:
    """Yield the edits of several changes. `left_changes` are those of no edit so far: the caller takes them out."""
    project_id = comparison.after.architecture.project.id
    for left_out in find_left_out(comparison, left_changes):
        yield Edit("removed", "project", project_id, left_out.text, left_out.removals)
    for type_edit in find_type_edits(comparison, left_changes):
        members = tuple(type_edit.changes)
        yield Edit("changed", "component_type", type_edit.component_type, type_edit.text, members)
    for reshaping in find_reshapings(comparison):
        members = tuple(change for change in left_changes if reshaping.brought_about(change))
        if members:
            confidence = reshaping.confidence
            text = reshaping.text + note_confidence(confidence)
            if reshaping.kind == "copied":
                sentence, _, effects = members[0].text.partition("; ")
                text = "; ".join(filter(None, (f"{sentence}, {text}", effects)))
            yield Edit(
                reshaping.kind, "component", reshaping.component_id, text, members, confidence, reshaping.related_ids
            )
    yield from _renames_in_instances(comparison, left_changes)
    yield from _exchanged_ids(left_changes)
    yield from _other_numbers(left_changes)
    yield from _merged_groups(left_changes)
    yield from _other_namespaces(left_changes)
    yield from _follow_ups_of_renames(left_changes)
    yield from _new_fields(left_changes)
    yield from _keys_of_one_element(left_changes)


def _renames_in_instances(comparison: Comparison, changes: Sequence[Change]) -> Iterator[Edit]:
    """Yield the parts of component types that are called otherwise, with their nodes: once for all instances."""
    architecture = comparison.after.architecture
    renames: dict[tuple[str, str, str], dict[str, Change]] = {}
    for change in changes:
        holder_id, _, name = change.element_id.rpartition(".")
        holder = architecture.find_component(holder_id) if _is_rename(change, {"component", "composed"}) else None
        if holder and holder.type_name:
            old_name = (change.old_id or "").rpartition(".")[2]
            renames.setdefault((holder.type_name, old_name, name), {})[change.element_id] = change
    for (type_name, old_name, name), members in renames.items():
        if len(members) > 1:
            followers = [
                change
                for change in changes
                if (
                    _is_rename(change, {"node"})
                    and not members.keys().isdisjoint(architecture.nodes[change.element_id].implements)
                )
                or (change.element_kind, change.element_id, change.key) == ("component_type", type_name, "components")
            ]
            instances = tick_names([each.rpartition(".")[0] for each in members], _MAX_INSTANCES)
            confidence = min(change.confidence for change in members.values())
            text = (
                f"component type `{type_name}`: component `{old_name}` is called `{name}` now; "
                f"in {len(members)} instances: {instances}, whose names follow{note_confidence(confidence)}"
            )
            yield Edit("renamed", "component_type", type_name, text, (*members.values(), *followers), confidence)


def _exchanged_ids(changes: Iterable[Change]) -> Iterator[Edit]:
    """Yield the pairs of components that have each other's ids now."""
    renames = {
        (change.old_id or "", change.element_id): change for change in changes if _is_rename(change, {"component"})
    }
    for (old_id, new_id), change in renames.items():
        other_change = renames.get((new_id, old_id))
        if other_change and old_id < new_id:
            effects = [each.text.partition("; ")[2] for each in (change, other_change)]
            text = "; ".join(
                filter(None, (f"components {tick_names((old_id, new_id))} have exchanged their ids", *effects))
            )
            yield Edit("renamed", "component", new_id, text, (change, other_change), change.confidence)


def _other_numbers(changes: Iterable[Change]) -> Iterator[Edit]:
    """Yield the requirements, and the use cases, that only got other ids."""
    for kind in ("use_case", "requirement"):
        renames = [change for change in changes if _is_rename(change, {kind}) and change.confidence >= SURE_CONFIDENCE]
        if len(renames) > 1:
            pairs = [f"`{change.old_id}` → `{change.element_id}`" for change in renames]
            text = f"{len(renames)} {ELEMENT_KINDS[kind].kind_word}s got other ids: {join_words(keep_first(pairs, _MAX_PAIRS))}"
            confidence = min(change.confidence for change in renames)
            yield Edit("renamed", kind, renames[0].element_id, text, tuple(renames), confidence)


def _is_rename(change: Change, kinds: Iterable[str]) -> bool:
    return change.kind in {"renamed", "moved"} and change.element_kind in kinds


def _merged_groups(changes: Iterable[Change]) -> Iterator[Edit]:
    """Yield the groups that are gone since all that they held moved to one other group."""
    moves_by_group: dict[str, list[Change]] = {}
    owner_changes = {change.element_id: change for change in changes if change.key == "owner"}
    for change in changes:
        if change.kind == "moved":
            moves_by_group.setdefault((change.old_id or "").partition(".")[0], []).append(change)
    for removal in [each for each in changes if (each.kind, each.element_kind) == ("removed", "group")]:
        moves = moves_by_group.get(removal.element_id, [])
        targets = list(dict.fromkeys(move.element_id.partition(".")[0] for move in moves))
        if len(targets) == 1 and not removal.parts:
            followers = [owner_changes[move.element_id] for move in moves if move.element_id in owner_changes]
            owner_notes = dict.fromkeys(each.text.partition("` ")[2] for each in followers)
            (target,) = targets
            sentence = f"group `{removal.element_id}` is merged into `{target}`, with {tick_names(move.element_id for move in moves)}"
            effects = [effect for move in moves if (effect := move.text.partition("; ")[2])]
            subject, verb = ("they", "belong") if len(followers) > 1 else ("it", "belongs")
            notes = [f"{subject} {note.replace('belongs', verb, 1)}" for note in owner_notes]
            text = "; ".join((sentence, *notes, *effects))
            members = (removal, *moves, *followers)
            confidence = min(move.confidence for move in moves)
            yield Edit("merged", "group", target, text, members, confidence, (removal.element_id,))


def _other_namespaces(changes: Iterable[Change]) -> Iterator[Edit]:
    """Yield the nodes in another namespace, with the topics that only follow it."""
    topic_changes = [change for change in changes if change.element_kind == "port" and change.key == "topic"]
    for change in list(changes):
        if change.element_kind == "node" and change.key == "namespace":
            old_space, new_space = (str(value or "").rstrip("/") for value in (change.before, change.after))
            followers = [
                each
                for each in topic_changes
                if each.element_id.partition(".")[0] == change.element_id
                and isinstance(each.before, list)
                and [f"{new_space}{str(name).removeprefix(old_space)}" for name in each.before] == each.after
            ]
            if followers:
                pairs = [each.text.partition(": ")[2].partition("; ")[0].partition(" ")[2] for each in followers]
                text = f"{change.text}; its names follow: {join_words(keep_first(pairs, _MAX_PAIRS))}"
                yield Edit("changed", "node", change.element_id, text, (change, *followers))


def _follow_ups_of_renames(changes: Iterable[Change]) -> Iterator[Edit]:
    """Yield the renames and moves of elements that got another title, or another group's owner, with their id."""
    follow_ups: dict[tuple[str, str], list[Change]] = {}
    for change in changes:
        if change.key in {"title", "owner"}:
            follow_ups.setdefault((change.element_kind, change.element_id), []).append(change)
    for change in list(changes):
        own_changes = follow_ups.get((change.element_kind, change.element_id))
        if own_changes and change.kind in {"renamed", "moved"}:
            sentence, separator, effects = change.text.partition("; ")
            notes = [f", {_shorten_follow_up(each)}" for each in own_changes]
            text = f"{sentence}{''.join(notes)}{separator}{effects}"
            members = (change, *own_changes)
            yield Edit(change.kind, change.element_kind, change.element_id, text, members, change.confidence)


def _shorten_follow_up(change: Change) -> str:
    """Return what changed, without the element that the sentence has named already."""
    if change.key == "title":
        return change.text.partition(": ")[2]
    return f"and {change.text.partition('` ')[2]}"


def _new_fields(changes: Iterable[Change]) -> Iterator[Edit]:
    """Yield the messages that got or lost fields, with what is said of these: units, frames, defaults."""
    for change in list(changes):
        if change.element_kind == "message" and change.key == "fields":
            fields = compare_field_lines(change.before, change.after)
            other_names = {line.rpartition(" ")[2] for line in (*fields.added, *fields.removed)}
            other_names |= {*fields.renamed, *fields.renamed.values()}
            members = [
                each
                for each in changes
                if each.element_kind == "message"
                and each.element_id == change.element_id
                and each.key
                and each.key.partition(".")[0] in {"comments", "defaults"}
                and each.key.rpartition(".")[2] in other_names
            ]
            if members:
                sentence, separator, effects = change.text.partition("; ")
                told_members = [each for each in members if not _follows_rename(each, members, fields.renamed)]
                notes = join_words([each.text.partition("; ")[0].partition(": ")[2] for each in told_members])
                text = "; ".join(filter(None, (sentence, notes))) + separator + effects
                yield Edit("changed", "message", change.element_id, text, (change, *members))


def _follows_rename(change: Change, others: Sequence[Change], new_names: Mapping[str, str]) -> bool:
    """Whether a text only went with its field to another name."""
    lead, _, name = (change.key or "").rpartition(".")
    for old_name, new_name in new_names.items():
        if name in {old_name, new_name}:
            keys = f"{lead}.{old_name}", f"{lead}.{new_name}"
            ends = {each.key: each for each in others}
            return all(key in ends for key in keys) and ends[keys[0]].before == ends[keys[1]].after
    return False


def _keys_of_one_element(changes: Iterable[Change]) -> Iterator[Edit]:
    """Yield the changed keys of one element that say how its timing is other than before, or that have one effect."""
    by_cause: dict[object, list[Change]] = {}
    for change in changes:
        if change.kind == "changed" and change.key and ": " in change.text:
            section = "timing" if change.key.startswith("timing.") else "" if change.breaks else change.key
            losses = frozenset((each.partner, each.reason) for each in change.breaks)
            by_cause.setdefault((change.element_kind, change.element_id, section, losses), []).append(change)
    for members in by_cause.values():
        subject = members[0].text.partition(": ")[0]
        if len(members) > 1 and all(change.text.startswith(f"{subject}: ") for change in members):
            text = f"{subject}: {join_words([change.text.removeprefix(f'{subject}: ') for change in members])}"
            first = members[0]
            yield Edit("changed", first.element_kind, first.element_id, text, tuple(members))
