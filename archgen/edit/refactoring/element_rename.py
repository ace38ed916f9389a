"""Rename an element wherever it is declared and named, so that nothing else changes; or say why not."""

from __future__ import annotations

from archgen.checking.reference_index import PATH_KINDS, Element
from archgen.diagnostics import did_you_mean
from archgen.edit.element_edit import EditRefusedError
from archgen.edit.refactoring.judged_version import JudgedVersion
from archgen.edit.refactoring.kept_names import KEEP_NONE, KeptNames
from archgen.edit.refactoring.model_proof import RenamedIds, rename_last_word
from archgen.edit.refactoring.refactoring import MAX_LISTED, NameTexts, Refactoring, prove_refactoring, refuse_unsound
from archgen.model.project_settings import is_agreement_file

_ODD_LETTERS = frozenset("\"'\\{}[],#&*!|>%@`:")
"""Letters that mean something in YAML, in selectors or in quotes: no name of an element has one."""
_MAX_LENGTH = 200


def find_element(version: JudgedVersion, name: str, kind: str | None = None) -> Element:
    """Return the element that a name means: its complete id, or the end of a path. Raise EditRefusedError."""
    found: dict[Element, Element] = {}
    known_names: dict[str, None] = {}
    for written in version.index.names:
        if kind in {None, written.kind} and (written.is_declaration or written.kind == "type"):
            plain_id = written.id.replace("<", "").replace(">", "")
            known_names |= dict.fromkeys((plain_id, plain_id.rpartition(".")[2]))
            if plain_id == name or (written.kind in PATH_KINDS and plain_id.endswith(f".{name}")):
                first_id = version.index.list_ids(written.kind, written.id)[0]
                found.setdefault(first_id, (written.kind, written.id))
    elements = list(found.values())
    complete = [each for each in elements if each[1] == name and each[0] != "type"]
    if len(elements) > 1 and len({each_kind for each_kind, _ in elements}) == 1 and len(complete) == 1:
        elements = complete
    if not elements:
        message = f"nothing is named `{name}`" if kind is None else f"no {kind.replace('_', ' ')} is named `{name}`"
        raise EditRefusedError(message, did_you_mean(name, known_names) or "`archgen list` shows what there is")
    if len(elements) > 1:
        listed = ", ".join(f"{each_kind.replace('_', ' ')} `{each_id}`" for each_kind, each_id in elements[:MAX_LISTED])
        raise EditRefusedError(f"`{name}` can mean {listed}", "say more of the path, or which kind with --kind")
    return elements[0]


def plan_rename(version: JudgedVersion, element: Element, new_name: str, kept: KeptNames = KEEP_NONE) -> Refactoring:
    """Return what gives an element another name, proved. Raise EditRefusedError, with the reason and what to do."""
    refuse_unsound(version)
    kind, element_id = element
    odd = next((letter for letter in new_name if letter in _ODD_LETTERS or not letter.isprintable()), None)
    if odd is not None or not new_name.strip() or len(new_name) > _MAX_LENGTH:
        what = "is empty or too long" if odd is None else f"has {odd!r} in it"
        raise EditRefusedError(f"the new name {what}", "choose a plain one, such as `arm_planner`")
    path, _, old_name = element_id.rpartition(".") if kind in PATH_KINDS else ("", "", element_id)
    if path and "." in new_name:
        new_path, _, new_word = new_name.rpartition(".")
        if f".{path}".endswith(f".{new_path}"):
            new_name = new_word  # the path that it has
        elif kind != "parameter":
            message = f"`{element_id}` does not stand in `{new_path}`, and keeps its place when it is renamed"
            raise EditRefusedError(
                message, f"write the name alone, `{new_word}`; `archgen move` gives it another place"
            )
    if "$(" in old_name and "$(" not in new_name:
        # Of a frame that parameters name, the words behind them are its own.
        new_name = old_name[: old_name.rindex(")") + 1] + new_name
    if new_name == old_name:
        raise EditRefusedError(f"`{element_id}` is called so already")
    if kind == "partner":
        _refuse_partner_files(version, element_id, new_name)
    elements = version.index.list_ids(kind, element_id)
    renamed = rename_last_word(elements, new_name, is_path=kind in PATH_KINDS)
    refuse_taken(version, renamed)
    texts = NameTexts(version, renamed)
    declared = False
    for name, number in version.index.list_names_through(kind, element_id):
        texts.rename_word(name, number, new_name)
        declared = declared or name.is_declaration
    if not declared and kind != "type":
        raise EditRefusedError(f"`{element_id}` is declared nowhere that can be edited")
    return prove_refactoring(version, renamed, texts, kept)


def _refuse_partner_files(version: JudgedVersion, partner: str, new_name: str) -> None:
    """Raise EditRefusedError for what is found by the id of a partner, or was signed under it: it would be found no more."""
    for agreement in version.project.architecture.agreements.values():
        if partner in agreement.pair:
            message = f"{agreement.at} is an agreement under the ids of both partners"
            new_id = "-".join(new_name if each == partner else each for each in agreement.pair)
            help_line = (
                "what was signed names them: take the agreement away, rename, and let both sign again"
                if agreement.signed
                else f"take it away, rename, and write it again as `{new_id}`"
            )
            raise EditRefusedError(message, help_line)
    for file in version.project.yaml_files:
        folder, _, stem = file.removesuffix(".yaml").rpartition("/")
        words = stem.split("-")
        if is_agreement_file(file) and partner in words:
            new_file = f"{folder}/{'-'.join(new_name if each == partner else each for each in words)}.yaml"
            raise EditRefusedError(f"{file} is read by the id of the partner", f"`git mv {file} {new_file}` first")


def refuse_taken(version: JudgedVersion, renamed: RenamedIds) -> None:
    """Raise EditRefusedError where an element has an id already that another one is to get."""
    for kind, new_id in renamed.pairs.values():
        holder = next((each for each in version.index.list_names(kind, new_id) if each.is_declaration), None)
        if holder is not None:
            message = f"the name is taken: {holder.span} declares the {kind.replace('_', ' ')} `{new_id}`"
            raise EditRefusedError(message, "choose another one")
