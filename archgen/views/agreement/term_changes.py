"""What an agreement gained, lost and changed since an earlier revision, term by term.

Interfaces and terms are paired by the ids that `compare.match_elements` found, never by a rule of the agreement's own.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from fractions import Fraction

from archgen.compare.comparison import ChangeKind
from archgen.compare.interface_figures import UNCHANGED_SHARE
from archgen.compare.matched_ids import MatchedIds
from archgen.frozen import dataclass, field
from archgen.model.agreed_terms import RULES
from archgen.views.agreement.interface_record import InterfaceKey, InterfaceRecord
from archgen.views.agreement.plain_terms import PlainTerm
from archgen.views.agreement.promise_rows import SOURCE_PHRASE, is_weaker
from archgen.views.changes.change_wording import CHANGE_SIGNS, choose_mark
from archgen.views.shapes import Text
from archgen.views.short_figures import QUANTITY

NAME_KIND = "name"
"""The kind of the term that a renamed interface has its old and new id in."""


def mark_changed_names(shown: Mapping[str, object], earlier: Mapping[str, object]) -> dict[str, Text]:
    """Return what happened to each name since the earlier revision, of those that are not what they were."""
    names = [name for name in {**earlier, **shown} if shown.get(name) != earlier.get(name)]
    return {
        name: write_signed_kind("removed" if name not in shown else "added" if name not in earlier else "changed")
        for name in names
    }


def write_signed_kind(kind: ChangeKind) -> Text:
    """Return a kind of change as a sign and a word, so that nothing depends on colour."""
    return Text(f"{CHANGE_SIGNS[kind]} {kind}", change=choose_mark(kind))


@dataclass(frozen=True, slots=True)
class TermChange:
    """A term that was added (`before` is None), removed (`after` is None), changed, or only renamed.

    `is_expected`: nobody promises it; `is_weaker`: less is promised than before.
    """

    kind: ChangeKind
    term_kind: str
    name: str
    before: str | None
    after: str | None
    is_expected: bool = False
    is_weaker: bool = False


@dataclass(frozen=True, slots=True)
class InterfaceChange:
    """What happened to an interface that is in both revisions. `old_name` is empty if it has the same id in both."""

    kind: ChangeKind
    old_name: str
    terms: tuple[TermChange, ...]


@dataclass(frozen=True, slots=True)
class AgreementChanges:
    """`added_keys` are of the later revision, `removed_records` of the earlier one; `changes_by_key` are of interfaces
    in both.
    """

    earlier_revision: str
    added_keys: frozenset[InterfaceKey] = frozenset()
    removed_records: tuple[InterfaceRecord, ...] = ()
    changes_by_key: Mapping[InterfaceKey, InterfaceChange] = field(default_factory=dict)
    earlier_versions: Mapping[InterfaceKey, str] = field(default_factory=dict)
    """The version that an interface of the earlier revision had there, also of those that are gone."""
    later_versions: Mapping[InterfaceKey, str] = field(default_factory=dict)
    changed_words: tuple[str, ...] = ()
    """What is agreed otherwise for all interfaces, by the titles of terms."""

    def terms_of(self, key: InterfaceKey) -> tuple[TermChange, ...]:
        """Return the changed terms of an interface that is in both revisions."""
        change = self.changes_by_key.get(key)
        return change.terms if change else ()

    def change_kind(self, key: InterfaceKey) -> ChangeKind | None:
        """Return what happened to an interface of the later revision, None for nothing."""
        change = self.changes_by_key.get(key)
        return "added" if key in self.added_keys else change.kind if change else None

    @property
    def has_changes(self) -> bool:
        """Whether anything changed."""
        return bool(self.added_keys or self.removed_records or self.changes_by_key)

    @property
    def kind_counts(self) -> str:
        """Return how many interfaces there are of each kind of change: `1 added, 2 renamed`."""
        counts = Counter[ChangeKind](change.kind for change in self.changes_by_key.values())
        counts["added"], counts["removed"] = len(self.added_keys), len(self.removed_records)
        order: tuple[ChangeKind, ...] = ("added", "changed", "renamed", "moved", "removed")
        return ", ".join(f"{counts[kind]} {kind}" for kind in order if counts[kind])


def compare_revisions(
    earlier_revision: str,
    old_records: Sequence[InterfaceRecord],
    new_records: Sequence[InterfaceRecord],
    matched_ids: MatchedIds,
    rules: int = RULES,
) -> AgreementChanges:
    """Compare two revisions; `rules` are those by which versions are told."""
    old_by_key = {record.key: record for record in old_records}
    new_by_key = {record.key: record for record in new_records}
    _follow_renamed_topics(old_by_key, new_by_key, matched_ids)
    changes_by_key = {
        key: change
        for key, record in new_by_key.items()
        if key in old_by_key and (change := _compare_records(old_by_key[key], record, matched_ids))
    }
    return AgreementChanges(
        earlier_revision,
        frozenset(key for key in new_by_key if key not in old_by_key),
        tuple(record for key, record in old_by_key.items() if key not in new_by_key),
        changes_by_key,
        {key: record.terms.find_version(rules) for key, record in old_by_key.items()},
        {key: record.terms.find_version(rules) for key, record in new_by_key.items()},
    )


def _follow_renamed_topics(
    old_by_key: dict[InterfaceKey, InterfaceRecord],
    new_by_key: Mapping[InterfaceKey, InterfaceRecord],
    matched_ids: MatchedIds,
) -> None:
    """Pair topics without an output that are called after a renamed element."""
    for key in [key for key, record in old_by_key.items() if record.terms.interface.output is None]:
        # Only a topic that is gone: a written name may contain a renamed word by chance, and stay.
        new_key = (matched_ids.rename_in_text(key[0]), key[1])
        if key not in new_by_key and new_key in new_by_key and new_key not in old_by_key:
            old_by_key[new_key] = old_by_key.pop(key)


def _compare_records(
    old_record: InterfaceRecord, new_record: InterfaceRecord, matched_ids: MatchedIds
) -> InterfaceChange | None:
    """Return what happened to an interface, None for nothing."""
    old_name, new_name = old_record.terms.interface.key, new_record.terms.interface.key
    term_changes = tuple(_compare_terms(old_record.plain_terms, new_record.plain_terms))
    if old_name == new_name:
        return InterfaceChange("changed", "", term_changes) if term_changes else None
    kind = _rename_kind(old_record, new_record, matched_ids)
    return InterfaceChange(kind, old_name, (TermChange(kind, NAME_KIND, "Name", old_name, new_name), *term_changes))


def _rename_kind(old_record: InterfaceRecord, new_record: InterfaceRecord, matched_ids: MatchedIds) -> ChangeKind:
    """Return `moved` if the component is in another group, as the comparison says it."""
    old_output, new_output = old_record.terms.interface.output, new_record.terms.interface.output
    if old_output is None or new_output is None:
        return "renamed"
    old_group = matched_ids.common_id("group", old_output.component.partition(".")[0])
    return "renamed" if old_group == new_output.component.partition(".")[0] else "moved"


def _compare_terms(old_terms: Mapping[str, PlainTerm], new_terms: Mapping[str, PlainTerm]) -> list[TermChange]:
    term_changes = []
    # In the order of the later document, what is gone last. Names of terms hold titles; a new title alone changes no
    # term.
    for key, new_term in new_terms.items():
        old_term = old_terms.get(key)
        if old_term is None:
            term_changes.append(_describe_change("added", new_term, None, new_term))
        elif is_weaker(old_term.strength, new_term.strength) or not _says_the_same(old_term, new_term):
            term_changes.append(_describe_change("changed", new_term, old_term, new_term))
        elif old_term.text != new_term.text and key in {"type", "message"}:
            term_changes.append(_describe_change("renamed", new_term, old_term, new_term))
    gone_terms = (old_term for key, old_term in old_terms.items() if key not in new_terms)
    return [*term_changes, *(_describe_change("removed", old_term, old_term, None) for old_term in gone_terms)]


def _says_the_same(old_term: PlainTerm, new_term: PlainTerm) -> bool:
    """Whether two terms say the same; figures that only follow from others may differ by as little as in comparisons."""
    if not new_term.is_expected or old_term.identity == new_term.identity:
        return old_term.identity == new_term.identity
    texts = old_term.identity, new_term.identity
    figures = [[Fraction(match[2]) for match in QUANTITY.finditer(text)] for text in texts]
    words = [QUANTITY.sub(r"\1# \3", text) for text in texts]
    return words[0] == words[1] and all(
        abs(new - old) <= UNCHANGED_SHARE * max(old, new) for old, new in zip(*figures, strict=True)
    )


def _describe_change(
    kind: ChangeKind, shown_term: PlainTerm, old_term: PlainTerm | None, new_term: PlainTerm | None
) -> TermChange:
    old_text, new_text = (term.text if term else None for term in (old_term, new_term))
    if old_text and new_text:
        (old_figure, _, old_source), (new_figure, _, new_source) = (
            text.partition(SOURCE_PHRASE) for text in (old_text, new_text)
        )
        old_text, new_text = (old_figure, new_figure) if old_source == new_source else (old_text, new_text)
    return TermChange(
        kind,
        shown_term.kind,
        shown_term.name,
        old_text,
        new_text,
        shown_term.is_expected,
        old_term is not None and is_weaker(old_term.strength, new_term.strength if new_term else {}),
    )
