"""What own code names by the package that it stood in before: generated files that are beside it still, in another package."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator

from archgen.emit.workspace.own_code import CodeFinding

_IMPORT = re.compile(r"^[ \t]*(?:from|import)[ \t]+(?P<package>\w+)\.(?P<name>\w+)", re.MULTILINE)
_INCLUDE = re.compile(r"^[ \t]*#[ \t]*include[ \t]+[\"<](?P<package>\w+)/(?P<name>[\w./]+)[\">]", re.MULTILINE)
_NAMESPACE = re.compile(r"^[ \t]*(?:inline[ \t]+)?namespace[ \t]+(?P<package>\w+)", re.MULTILINE)


def find_moved_packages(path: str, data: bytes, wanted_paths: Collection[str]) -> Iterator[CodeFinding]:
    """Yield where a file imports or includes what its package has under another name of the package, and such namespaces."""
    text = data.decode("utf-8", "replace")
    is_python = path.endswith(".py")
    own_folder = "/".join(path.split("/")[:2])
    new_packages: dict[str, str] = {}
    for found in (_IMPORT if is_python else _INCLUDE).finditer(text):
        package, name = found["package"], f"{found['name']}.py" if is_python else found["name"]
        if any(each.endswith(f"/{package}/{name}") for each in wanted_paths):
            continue
        beside = [each for each in wanted_paths if each.startswith(f"{own_folder}/") and each.endswith(f"/{name}")]
        if len(beside) == 1:
            new_packages[package] = beside[0].removesuffix(f"/{name}").rpartition("/")[2]
            # As the patch finds it: a dotted word, or a text.
            frame = "{}.{}" if is_python else '"{}/{}"'
            names = (frame.format(each, found["name"]) for each in (package, new_packages[package]))
            yield _tell(text, found, f"`{package}` has no `{found['name']}` any more", new_packages[package], *names)
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
