"""What own code names by the package that it stood in before: generated files that are beside it still, in another package."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping

from archgen.emit.workspace.disk_files import GeneratedFile
from archgen.emit.workspace.own_code import CodeFinding

_IMPORT = re.compile(r"^[ \t]*(?:from|import)[ \t]+(?P<package>\w+)\.(?P<name>\w+)", re.MULTILINE)
_INCLUDE = re.compile(r"^[ \t]*#[ \t]*include[ \t]+[\"<](?P<package>\w+)/(?P<name>[\w./]+)[\">]", re.MULTILINE)
_NAMESPACE = re.compile(r"^[ \t]*(?:inline[ \t]+)?namespace[ \t]+(?P<package>\w+)", re.MULTILINE)


def find_moved_packages(
    path: str, data: bytes, wanted_files: Mapping[str, Collection[GeneratedFile]]
) -> Iterator[CodeFinding]:
    """Yield where a file imports or includes what its package has under another name of the package, and such namespaces.

    `wanted_files` are those that are generated, by the last part of their paths.
    """
    text = data.decode("utf-8", "replace")
    is_python = path.endswith(".py")
    own_folder = "/".join(path.split("/")[:2])
    found_names: list[tuple[re.Match[str], str]] = []
    new_packages: dict[str, str] = {}
    for found in (_IMPORT if is_python else _INCLUDE).finditer(text):
        package, name = found["package"], f"{found['name']}.py" if is_python else found["name"]
        alike = [each for each in wanted_files.get(name.rpartition("/")[2], ()) if each.path.endswith(f"/{name}")]
        beside = [each for each in alike if each.path.startswith(f"{own_folder}/")]
        if len(beside) == 1 and not any(each.path.endswith(f"/{package}/{name}") for each in alike):
            new_package = beside[0].path.removesuffix(f"/{name}").rpartition("/")[2]
            found_names.append((found, new_package))
            # The module of a component called `clock` is no `rclpy.clock`: it alone says nothing of a package.
            if not (is_python and beside[0].once):
                new_packages[package] = new_package
    # As the patch finds it: a dotted word, or a text.
    frame = "{}.{}" if is_python else '"{}/{}"'
    for found, new_package in found_names:
        if found["package"] in new_packages:
            names = (frame.format(each, found["name"]) for each in (found["package"], new_package))
            yield _tell(text, found, f"`{found['package']}` has no `{found['name']}` any more", new_package, *names)
    for found in () if is_python else _NAMESPACE.finditer(text):
        if found["package"] in new_packages:
            new_package = new_packages[found["package"]]
            reason = "what is generated is in another namespace"
            yield _tell(text, found, reason, new_package, found["package"], new_package)


def _tell(  # noqa: PLR0913, PLR0917 - what a finding is made of
    text: str, found: re.Match[str], reason: str, new_package: str, old_name: str, new_name: str
) -> CodeFinding:
    start = found.start("package")
    line, column = text.count("\n", 0, start) + 1, start - text.rfind("\n", 0, start)
    return CodeFinding(f"{reason}: it is `{new_package}` now", line, column, old_name=old_name, new_name=new_name)
