"""What an agreement gained, lost and changed since an earlier revision, term by term.

A comparison of its own beside `archgen.compare`: it knows nothing of matched ids.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from archgen.views.agreement.interface_terms import InterfaceTerms
from archgen.views.agreement.partner_interfaces import PartnerInterface

SIGNED_KINDS = {"added": "+ added", "removed": "\u2212 removed", "changed": "~ changed"}
"""A sign and a word for each kind of change, so that nothing depends on colour."""
_TERM_KIND_NAMES = {"end": "who gives and takes", "field": "fields", "chain": "chains", "requirement": "requirements"}
PlainTerms = Mapping[str, tuple[str, str]]
InterfaceKey = tuple[str, tuple[str, str]]


@dataclass(frozen=True, slots=True)
class InterfaceRecord:
    """An interface of one revision with its terms as plain text."""

    terms: InterfaceTerms
    plain_terms: PlainTerms

    @property
    def key(self) -> InterfaceKey:
        """Return what identifies an interface: what flows, and between whom."""
        return self.terms.interface.key, self.terms.interface.pair


@dataclass(frozen=True, slots=True)
class TermChange:
    """A term that was added (`before` is None), removed (`after` is None) or changed."""

    key: str
    name: str
    before: str | None
    after: str | None

    @property
    def term_kind(self) -> str:
        """Return the kind of the term in a word or two."""
        return _TERM_KIND_NAMES.get(self.key.partition(" ")[0]) or (
            self.name if self.name.startswith("QoS") else self.name.lower()
        )

    @property
    def kind(self) -> Literal["added", "removed", "changed"]:
        """Return what happened to the term."""
        return "added" if self.before is None else "removed" if self.after is None else "changed"


@dataclass(frozen=True, slots=True)
class AgreementChanges:
    """`added_keys` are of the later revision, `removed_records` of the earlier one; `changes_by_key` are of interfaces
    in both.
    """

    earlier_revision: str
    added_keys: frozenset[InterfaceKey] = frozenset()
    removed_records: tuple[InterfaceRecord, ...] = ()
    changes_by_key: Mapping[InterfaceKey, tuple[TermChange, ...]] | None = None

    def changes_of(self, key: InterfaceKey) -> tuple[TermChange, ...]:
        """Return the changes of an interface that is in both revisions."""
        return (self.changes_by_key or {}).get(key, ())

    def change_kind(self, key: InterfaceKey) -> Literal["added", "changed", ""]:
        """Return what happened to an interface of the later revision, empty for nothing."""
        return "added" if key in self.added_keys else "changed" if self.changes_of(key) else ""

    @property
    def has_changes(self) -> bool:
        """Whether anything changed."""
        return bool(self.added_keys or self.removed_records or self.changes_by_key)


def compare_revisions(
    earlier_revision: str, old_records: Sequence[InterfaceRecord], new_records: Sequence[InterfaceRecord]
) -> AgreementChanges:
    """Compare two revisions. A renamed interface is the same if its topics and message stayed."""
    old_by_key = {record.key: record for record in old_records}
    new_by_key = {record.key: record for record in new_records}
    lost_by_key = {key: record for key, record in old_by_key.items() if key not in new_by_key}
    old_by_new_key: dict[InterfaceKey, InterfaceRecord] = {
        key: old_by_key[key] for key in new_by_key if key in old_by_key
    }
    for key in [key for key in new_by_key if key not in old_by_key]:
        same_carrier = [
            lost_key
            for lost_key, record in lost_by_key.items()
            if _carrier_of_record(record) == _carrier_of_record(new_by_key[key]) and _carrier_of_record(record)
        ]
        # With several candidates it is open which one was renamed; then all count as added and removed.
        if len(same_carrier) == 1:
            old_by_new_key[key] = lost_by_key.pop(same_carrier[0])
    changes_by_key = {
        key: term_changes
        for key, record in old_by_new_key.items()
        if (term_changes := tuple(_compare_terms(record.plain_terms, new_by_key[key].plain_terms)))
    }
    return AgreementChanges(
        earlier_revision,
        frozenset(key for key in new_by_key if key not in old_by_new_key),
        tuple(lost_by_key.values()),
        changes_by_key,
    )


def _carrier_of_record(record: InterfaceRecord) -> tuple[object, ...]:
    """Return what identifies an interface besides its name, nothing if no topic carries it."""
    interface: PartnerInterface = record.terms.interface
    return (interface.pair, interface.flow, interface.topic_names, interface.message) if interface.topic_names else ()


def _compare_terms(old_terms: PlainTerms, new_terms: PlainTerms) -> list[TermChange]:
    term_changes = []
    # In the order of the later document, what is gone last.
    for key in (*new_terms, *(key for key in old_terms if key not in new_terms)):
        old_term, new_term = old_terms.get(key), new_terms.get(key)
        # Names of terms hold titles; a new title alone changes no term.
        if (old_term and old_term[1]) != (new_term and new_term[1]):
            term_changes.append(
                TermChange(
                    key, (new_term or old_term or ("", ""))[0], old_term and old_term[1], new_term and new_term[1]
                )
            )
    return term_changes
