"""From a checked project to who owns what in it, and to CODEOWNERS.

Find the files in which an element is written: every slice of it, not only the first.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from archgen.checking.checked_project import CheckedProject
from archgen.emit import codeowners_file as emitter
from archgen.emit.codeowners_file import CodeownersFile
from archgen.frozen import replace
from archgen.git import NoRepositoryError, find_repository
from archgen.link import mapping_values
from archgen.model.agreed_terms import signature_file
from archgen.model.architecture import Partner
from archgen.model.element_ids import ElementFiles
from archgen.model.project_settings import agreement_file
from archgen.syntax.yaml_tree import MappingNode, SequenceNode, YamlNode
from archgen.views.partner_ownership import Ownership
from archgen.views.partner_ownership import assign_ownership as sorted_out


def find_ownership(checked_project: CheckedProject) -> Ownership:
    """Find out which partner owns which elements and files of a project."""
    # Files come from the merged tree: the architecture keeps one span for an element, but slices may add to it in
    # others.
    ownership = sorted_out(
        checked_project.architecture, find_element_files(checked_project.merged_table), checked_project.yaml_files
    )
    loaded_project = checked_project.loaded_project
    shared_files = dict.fromkeys((*loaded_project.interface_files, *loaded_project.library_files))
    return replace(ownership, shared_files=tuple(shared_files))


def make_codeowners(checked_project: CheckedProject, prefix: str | None = None) -> CodeownersFile:
    """Make CODEOWNERS. `prefix` is the project's folder relative to the root of the repository; None asks git."""
    return emitter.render_codeowners(
        _add_shared_files(find_ownership(checked_project), checked_project),
        _repository_prefix(checked_project.root) if prefix is None else prefix,
    )


def _add_shared_files(ownership: Ownership, checked_project: CheckedProject) -> Ownership:
    """Return an ownership in which all partners review what is nobody's, each the file of what it accepts, and
    both partners of an agreement what they signed.

    What is nobody's decides about everybody: archgen.yaml holds the policy, and types, messages and libraries cross all
    borders.
    """
    partners = tuple(checked_project.architecture.partners.values())
    shared_files = dict.fromkeys(ownership.shared_files, partners)
    owned_files = {file: owners or partners for file, owners in ownership.files.items()}
    agreement_files: dict[str, tuple[Partner, ...]] = {agreement_file(partner.id): (partner,) for partner in partners}
    agreement_files |= {
        signature_file(each.id): tuple(partner for partner in partners if partner.id in each.pair)
        for each in checked_project.architecture.agreements.values()
    }
    policy_file = {checked_project.loaded_project.first_file: partners}
    return replace(ownership, files={**shared_files, **owned_files, **policy_file, **agreement_files})


def _repository_prefix(root: Path) -> str:
    """Return the folder of a project relative to its repository, empty outside of any."""
    try:
        return find_repository(root).prefix
    except NoRepositoryError:
        return ""


def find_element_files(root: MappingNode) -> ElementFiles:
    """Return the files of every group, component and node; those of its components do not count for a group."""
    files: dict[tuple[str, str], tuple[str, ...]] = {}
    for name, entry, body in mapping_values.iterate_elements(root, "groups"):
        own_values = [part.value for part in body if part.key != "components"]
        components = mapping_values.get_mapping(body, "components")
        for part in components:
            files["component", f"{name}.{part.key}"] = _list_distinct_files(part.key_span.file, part.value)
        # A file that only adds components to a group writes the group's id too, but nothing about the group.
        files["group", name] = _list_distinct_files(
            "" if components.entries and not own_values else entry.key_span.file, *own_values
        )
    for name, entry, body in mapping_values.iterate_elements(root, "nodes"):
        files["node", name] = _list_distinct_files(entry.key_span.file, body)
    return files


def _list_distinct_files(first_file: str, *values: YamlNode) -> tuple[str, ...]:
    return tuple(
        dict.fromkeys(
            file
            for file in (first_file, *(value_file for value in values for value_file in _list_files_below(value)))
            if file
        )
    )


def _list_files_below(node: YamlNode) -> Iterator[str]:
    """Yield the file of every value below; a merged mapping holds entries of several files, a list only one file's."""
    if isinstance(node, MappingNode):
        for entry in node:
            yield entry.key_span.file
            yield from _list_files_below(entry.value)
    elif isinstance(node, SequenceNode):
        yield from (item.span.file for item in node.items)
    else:
        yield node.span.file
