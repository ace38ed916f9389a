"""What a change leaves of what partners signed: each agreement of `agreements` is held against it without being asked.

An agreement that the first version did not keep either is no news: a change breaks what it leaves by itself. Signatures that
are new are held against the commit that they name, so that nobody signs by editing a file.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from archgen.compare import Change, Comparison
from archgen.compare.agreements import AgreementJudge
from archgen.compare.breaking_changes import sort_breaks_first
from archgen.compare.comparison import PartnerBreak
from archgen.diagnostics import Severity, join_words, keep_first, shorten_hash
from archgen.frozen import dataclass, replace
from archgen.git import GitError, find_repository
from archgen.git.repository_lookup import look_up_commit
from archgen.model.agreed_terms import RULES, Agreement, Signature, find_agreement, signature_file
from archgen.pipeline import CheckedProject
from archgen.products.agreement_documents import make_timed_lookup
from archgen.products.agreement_signing import list_versions
from archgen.products.signed_agreements import read_agreed_version
from archgen.project import ProjectNotFoundError
from archgen.views.agreement.partner_agreement import compare_lookups, record_interfaces
from archgen.views.agreement.signed_terms import group_departures
from archgen.views.lookup import Lookup

_MAX_TOLD = 4
"""So many interfaces are told of an agreement that is left; the others are counted."""
Departures = Mapping[str, tuple[str, ...]]
"""What is not as it was signed, by interface, or by what else was agreed."""


def add_agreement_breaks(comparison: Comparison, before: CheckedProject, after: CheckedProject) -> Comparison:
    """Return a comparison with a break for each agreement that the change leaves, and each signature that is none."""
    if comparison.policy.agreement is Severity.OFF:
        return comparison
    changes = [change for each in _list_pairs(comparison, before, after) for change in each.find_breaks()]
    if not changes:
        return comparison
    partners = {each.partner for change in changes for each in change.breaks}
    return replace(
        comparison,
        changes=sort_breaks_first((*comparison.changes, *changes), comparison.policy),
        concerned_owners=tuple(sorted({*comparison.concerned_owners, *partners})),
    )


def _list_pairs(comparison: Comparison, before: CheckedProject, after: CheckedProject) -> Iterator[_AgreementPair]:
    """Yield the agreements of both versions, matched by partners."""
    old_agreements, new_agreements = (side.architecture.agreements for side in (before, after))
    matched_partners = {old: new for new, old in comparison.matched_ids.old_ids.get("partner", {}).items()}
    seen: set[str] = set()
    lookups: dict[int, tuple[CheckedProject, Lookup]] = {}
    for old in old_agreements.values():
        first, second = (matched_partners.get(partner, partner) for partner in old.pair)
        new = find_agreement(new_agreements, first, second)
        seen.add(new.id)
        yield _AgreementPair(comparison, before, after, old, new, lookups)
    for new in new_agreements.values():
        if new.id not in seen:
            yield _AgreementPair(comparison, before, after, Agreement(new.id), new, lookups)


@dataclass(frozen=True, slots=True)
class _AgreementPair:
    """An agreement in both versions of a comparison; it is empty where one of them does not have it."""

    comparison: Comparison
    before: CheckedProject
    after: CheckedProject
    old: Agreement
    new: Agreement
    lookups: dict[int, tuple[CheckedProject, Lookup]]
    """The look-ups of versions that were asked for, which all agreements share."""

    def find_breaks(self) -> Iterator[Change]:
        """Yield a change for each thing by which the second version departs from what was signed."""
        old, new = self.old.signed, self.new.signed
        if not (self.old.binding_signature or new):
            return
        if new is None:
            yield self._tell_withdrawal()
            return
        faults = list(self._find_faults(new, is_new=old != new))
        yield from (self._make_change(path, text, "is no signature") for path, text in faults)
        if self.new.binding_signature and not faults:
            yield from self._find_departures(new)

    def _tell_withdrawal(self) -> Change:
        text = f"the agreement {self._name(self.old.signed)} is withdrawn"
        change = self._make_change((), text, "ends what both signed", kind="removed")
        return AgreementJudge.from_comparison(self.comparison).judge(change, change.breaks)

    def _find_faults(self, signed: Signature, *, is_new: bool) -> Iterator[tuple[tuple[str, ...], str]]:
        """Yield by which key a signature is none, and why."""
        revision = signed.revision or ""
        if self.old.binding_signature and not self.new.binding_signature:
            missing = next(each for each in self.new.pair if each not in signed.by)
            yield ("by",), f"`{missing}` did not sign what takes the place of {self._name(self.old.signed)}"
        if signed.rules not in range(1, RULES + 1):
            yield ("rules",), f"the signature is by rules {signed.rules}, which this version of archgen does not know"
        elif not revision:
            yield ("revision",), "the signature names no commit"
        elif (tagged := self._find_tagged(signed)) not in {"", revision}:
            yield (
                ("tag",),
                f"the tag `{signed.tag}` stands at {shorten_hash(tagged)}, and {shorten_hash(revision)} was signed: it moved",
            )
        elif is_new:
            yield from self._verify(signed)

    def _find_tagged(self, signed: Signature) -> str:
        """Return the commit that the tag of a signature stands at, empty where it is not here."""
        try:
            return look_up_commit(find_repository(self.after.root), f"refs/tags/{signed.tag}") if signed.tag else ""
        except GitError:
            return ""

    def _verify(self, signed: Signature) -> Iterator[tuple[tuple[str, ...], str]]:
        """Yield what a signature that is new says otherwise than the commit that it names."""
        file, own_file = self.new.at.file, signature_file(self.new.id)
        if file != own_file and len(self.after.yaml_files) > 1:
            yield (), f"the signature stands in `{file}`: it counts in `{own_file}` alone"
        there = self._read_signed(signed)
        if there is None:
            name = shorten_hash(signed.revision or "")
            yield (
                ("revision",),
                f"what was signed cannot be read: the commit {name} is not here, or holds no sound project",
            )
            return
        versions = self._list_versions(there, signed.rules)
        for giver, key in sorted({(g, k) for each in (versions, signed.versions) for g in each for k in each[g]}):
            written, found = (each.get(giver, {}).get(key) for each in (signed.versions, versions))
            if written != found:
                path = (giver, key) if written else ("versions",)
                told = f"version {written} of `{key}`" if written else f"no `{key}` of `{giver}`"
                yield (
                    path,
                    f"the signature holds {told}, and {found or 'none'} is at {shorten_hash(signed.revision or '')}",
                )
        if find_agreement(there.architecture.agreements, *self.new.pair).hash_terms() != signed.terms:
            yield ("terms",), "the digits of the terms are not those of what was agreed in words when it was signed"

    def _read_signed(self, signed: Signature) -> CheckedProject | None:
        try:
            there = read_agreed_version(signed.revision or "", self.after).checked_project
        except (GitError, ProjectNotFoundError):
            return None
        return None if there.structural_errors else there

    def _find_departures(self, signed: Signature) -> Iterator[Change]:
        """Yield a change for the project, and for each variant, that is not as signed and was so before."""
        is_new = self.old.signed != signed
        there: CheckedProject | None = None
        told: dict[str, set[str]] = {}
        for name in ("", *(name for name in self.after.variants if name in self.before.variants)):
            before, after = (side.variants[name] if name else side for side in (self.before, self.after))
            # What is as it was before is as signed as it was before.
            if not is_new and not self._compare_standings(before, after):
                continue
            there = there or self._read_signed(signed)
            then = there.variants.get(name) if there and name else there
            if there and not then:
                continue
            old, new = (
                self._compare_standings(then, side) if then else self._compare_digits(signed, side)
                for side in (before, after)
            )
            # What was left before is no news, nor is what the project itself leaves in its variants.
            known = {key: _name_terms(() if is_new else old.get(key, ())) | told.get(key, set()) for key in new}
            left = {key: lines for key, lines in new.items() if _name_terms(lines) - known[key]}
            told = told or {key: _name_terms(lines) for key, lines in left.items()}
            if left:
                yield self._tell_departures(signed, left, name)

    def _tell_departures(self, signed: Signature, left: Departures, variant: str) -> Change:
        count = sum(len(versions) for versions in signed.versions.values())
        text = (
            f"of the agreement {self._name(signed)} {len(left)} of {count} interfaces would not be as signed"
            f"{f', in the variant `{variant}`' if variant else ''}: mend it, or let both sign again (`archgen sign "
            f"{' '.join(self.new.pair)}`)"
        )
        told = keep_first([f"{key} ({'; '.join(lines)})" for key, lines in left.items()], _MAX_TOLD)
        return self._make_change(("versions",), text, f"changes what was signed of {join_words(told)}")

    def _name(self, signed: Signature | None) -> str:
        return f"`{self.new.id}` of {signed.day}" if signed and signed.day else f"`{self.new.id}`"

    def _make_change(self, path: tuple[str, ...], text: str, reason: str, kind: str = "changed") -> Change:
        key = ".".join(("agreements", self.new.id, *path))
        breaks = tuple(PartnerBreak(partner, reason, category="agreement") for partner in self.new.pair)
        project_id = self.after.architecture.project.id
        return Change(kind, "project", project_id, key=key, breaks=breaks, text=text)  # type: ignore[arg-type]

    def _compare_standings(self, signed: CheckedProject, now: CheckedProject) -> Departures:
        """Return by interface what of a version is not as it was signed, and what of the terms of all."""
        changes = compare_lookups(("", self._look_at(signed)), self._look_at(now), self.new.pair)
        departures: dict[str, tuple[str, ...]] = {}
        for key, lines in group_departures(changes).items():
            departures[f"`{key[0]}`"] = (*departures.get(f"`{key[0]}`", ()), *lines)
        return departures | ({"the terms": changes.changed_words} if changes.changed_words else {})

    def _compare_digits(self, signed: Signature, now: CheckedProject) -> Departures:
        """Return what is not as it was signed by the versions alone, where the signed commit is not here."""
        versions = self._list_versions(now, signed.rules)
        pairs = {(giver, key) for each in (versions, signed.versions) for giver in each for key in each[giver]}
        return {
            f"`{key}`": (f"version {found or 'none'}, {written or 'none'} was signed",)
            for giver, key in sorted(pairs)
            if (found := versions.get(giver, {}).get(key)) != (written := signed.versions.get(giver, {}).get(key))
        }

    def _list_versions(self, version: CheckedProject, rules: int) -> dict[str, dict[str, str]]:
        return list_versions(record_interfaces(self._look_at(version), self.new.pair), rules)

    def _look_at(self, version: CheckedProject) -> Lookup:
        if id(version) not in self.lookups:
            self.lookups[id(version)] = version, make_timed_lookup(version)
        return self.lookups[id(version)][1]


def _name_terms(lines: Iterable[str]) -> set[str]:
    """Return which terms lines speak of, whatever they were and are."""
    return {line.removeprefix("weaker: ").partition(" was ")[0] for line in lines}
