"""Sign an agreement: versions of all interfaces at a commit, a tag that records it, and the file `agreements/A-B.yaml`."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping

from archgen.diagnostics import make_visible
from archgen.emit import file_tree
from archgen.frozen import dataclass, replace
from archgen.git import GitError, GitRepository, find_repository, resolve_revision
from archgen.git.git_call import run_git
from archgen.git.project_revision import differs_from_head
from archgen.git.repository_lookup import look_up_commit
from archgen.model.agreed_terms import RULES, Agreement, Signature, find_agreement, is_signature_file, signature_file
from archgen.pipeline import CheckedProject
from archgen.project import find_tracked_project
from archgen.project.project_tracking import load_at_commit
from archgen.regular_files import holds_bytes
from archgen.syntax import yaml_parser
from archgen.syntax.yaml_tree import MappingNode
from archgen.views.agreement.interface_record import InterfaceRecord

_HEAD_LINE = "# What two partners agreed on. `archgen sign` writes `signed`: edits of it by hand are found.\n"


class SigningError(ValueError):
    """An agreement cannot be signed as things stand; the text says why and what can be done."""


@dataclass(frozen=True, slots=True)
class PreparedSignature:
    """A signature that is not recorded yet: the agreement with it, the text of its file, and the words of its tag."""

    agreement: Agreement
    file: str
    text: str
    repository: GitRepository
    message: str

    @property
    def signature(self) -> Signature:
        """Return what is signed."""
        return self.agreement.signed or Signature()

    @property
    def missing_partners(self) -> tuple[str, ...]:
        """Return who has still to sign."""
        return tuple(each for each in self.agreement.pair if each not in self.signature.by)


def list_versions(records: Iterable[InterfaceRecord], rules: int = RULES) -> dict[str, dict[str, str]]:
    """Return the version of each interface, by giver and key."""
    versions: dict[str, dict[str, str]] = {}
    for record in sorted(records, key=lambda each: each.key):
        versions.setdefault(record.key[1][0], {})[record.key[0]] = record.terms.find_version(rules)
    return versions


def prepare_signature(
    checked_project: CheckedProject,
    pair: tuple[str, str],
    records: Iterable[InterfaceRecord],
    signers: Mapping[str, str],
    day: str,
) -> PreparedSignature:
    """Return the signature of HEAD by `signers`, names by partner. Raise SigningError, and `git.GitError`.

    What one partner signed before joins with it if it was the same; it takes two to bind them.
    """
    agreement = find_agreement(checked_project.architecture.agreements, *pair)
    file = signature_file(agreement.id)
    if agreement.at.file and agreement.at.file != file:
        msg = f"`{agreement.id}` stands at {agreement.at}: move it into `{file}`, which both partners review"
        raise SigningError(msg)
    if strangers := [each for each in signers if each not in agreement.pair]:
        msg = f"`{strangers[0]}` is none of the two partners `{agreement.pair[0]}` and `{agreement.pair[1]}`"
        raise SigningError(msg)
    if unclear := [who for who in signers.values() if not who.strip() or who != make_visible(who)]:
        raise SigningError(f'{unclear[0]!r} is no name that can stand in a line: write who signs, such as "M. Rossi"')
    repository = find_repository(checked_project.root)
    head = resolve_revision(repository, "HEAD")
    _refuse_uncommitted(checked_project, head, file)
    versions, terms = list_versions(records), agreement.hash_terms()
    by, revision = {name: f"{who}, {day}" for name, who in signers.items()}, head
    earlier = agreement.signed
    if earlier and earlier.by and not agreement.binding_signature and set(earlier.by).isdisjoint(by):
        if (earlier.versions, earlier.terms, earlier.rules) != (versions, terms, RULES):
            raise SigningError(
                f"`{next(iter(earlier.by))}` signed something else at `{earlier.tag}`: sign it there (`git checkout "
                f"{earlier.tag}`), or let both sign what is here"
            )
        by, revision = {**earlier.by, **by}, earlier.revision or head
    signature = Signature(
        RULES,
        _name_tag(repository, agreement.id, day),
        revision,
        terms,
        {name: by[name] for name in agreement.pair if name in by},
        versions,
    )
    partners = checked_project.architecture.partners
    names = "; ".join(f"{partners[name].title}: {who}" for name, who in signature.by.items())
    agreement = replace(agreement, signed=signature)
    text = _write_text(agreement, file, checked_project.sources.text_of(file) or "")
    return PreparedSignature(agreement, file, text, repository, f"Signed for {names}")


def record_signature(checked_project: CheckedProject, prepared: PreparedSignature) -> None:
    """Make the tag, then the file, or neither. Raise `git.GitError`, and `file_tree.OutputError`."""
    tag, revision = prepared.signature.tag or "", prepared.signature.revision or ""
    # Not as an argument, which an ASCII locale cannot pass on.
    message = prepared.message.encode("utf-8", "replace")
    result = run_git(prepared.repository.top, "tag", "-a", "--no-sign", "-F", "-", tag, revision, stdin=message)
    if result.status:
        reason = result.error_text.removeprefix("fatal: ").partition("\n")[0]
        raise GitError(f"git makes no tag `{tag}`: {reason}")
    target, text = checked_project.root / prepared.file, prepared.text.encode()
    try:
        file_tree.write_file(target, text)
    finally:  # after Ctrl-C, too
        if not holds_bytes(target, text):
            run_git(prepared.repository.top, "tag", "-d", tag)


def _refuse_uncommitted(checked_project: CheckedProject, head: str, own_file: str) -> None:
    """Raise SigningError where a file of the project is not as HEAD has it; signatures of other pairs may wait."""
    committed = load_at_commit(find_tracked_project(checked_project.root), head)
    files = {*checked_project.input_files, *committed.sources.file_names(), *committed.interface_files}
    own_files = [each for each in sorted(files) if each == own_file or not is_signature_file(each)]
    changed = [each for each in own_files if differs_from_head(checked_project.root, [each])]
    if changed:
        raise SigningError(
            f"`{changed[0]}` is not as it was committed{f', nor are {len(changed) - 1} more' if changed[1:] else ''}: "
            "what is signed is a commit, so commit first"
        )


def _name_tag(repository: GitRepository, agreement_id: str, day: str) -> str:
    """Return a tag that there is not yet: `signed/certh-sssa/2026-03-31`, with a number from the second of a day on."""
    tag, number = f"signed/{agreement_id}/{day}", 1
    while look_up_commit(repository, f"refs/tags/{tag}"):
        number += 1
        tag = f"signed/{agreement_id}/{day}.{number}"
    return tag


def _write_text(agreement: Agreement, file: str, text: str) -> str:
    """Return the text of a file with the signature as its last part, all before it as it was. Raise SigningError."""
    text = text if text.strip() else f"{_HEAD_LINE}agreements:\n  {agreement.id}:\n"
    body, indent, line = _find_body(agreement.id, file, text)
    entry = body.entries.get("signed") if body else None
    lines = text.splitlines(keepends=True)
    if entry:
        indent, line = entry.key_span.column - 1, entry.key_span.line
    kept = "".join(lines[: line - 1]) if entry else text.rstrip("\r\n") + "\n"
    new_text = kept + "".join(f"{' ' * indent}{each}\n" for each in _write_lines(agreement.signed or Signature()))
    written, _, _ = _find_body(agreement.id, file, new_text)
    rest = "".join(lines[entry.value.span.end_line - 1 :])[entry.value.span.end_column - 1 :] if entry else ""
    if written is None or "signed" not in written.entries or any(each.strip(" \r\n") for each in rest.splitlines()[1:]):
        raise SigningError(f"`{file}`: write the terms of `{agreement.id}` in block form, with nothing behind `signed`")
    return new_text


def _find_body(agreement_id: str, file: str, text: str) -> tuple[MappingNode | None, int, int]:
    """Return what a text says of an agreement, at which column its keys begin, and its line."""
    document, _ = yaml_parser.parse_yaml(file, text)
    section = document.root.entries.get("agreements") if document else None
    agreements = section.value if section and isinstance(section.value, MappingNode) else None
    entry = agreements.entries.get(agreement_id) if agreements else None
    if entry is None:
        return None, 0, 1
    body = entry.value if isinstance(entry.value, MappingNode) and entry.value.entries else None
    first = next(iter(body.entries.values())).key_span.column - 1 if body else entry.key_span.column + 1
    return body, first, entry.key_span.line


def _write_lines(signature: Signature) -> Iterator[str]:
    """Yield the lines of a signature in block form; JSON's strings are YAML's."""
    yield "signed:"
    yield f"  rules: {signature.rules}"
    yield f"  tag: {signature.tag}"
    yield f'  revision: "{signature.revision}"'
    yield f'  terms: "{signature.terms}"'
    yield "  by:"
    yield from (f"    {name}: {json.dumps(who, ensure_ascii=False)}" for name, who in signature.by.items())
    yield "  versions:"
    for giver, versions in signature.versions.items():
        yield f"    {giver}:"
        yield from (
            f'      {json.dumps(key) if key[0] == "/" else key}: "{version}"' for key, version in versions.items()
        )
