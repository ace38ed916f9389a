"""Own code that was moved to another package names what is beside it by the old one: told, with the new one."""

from __future__ import annotations

import pytest

from archgen.emit.workspace.moved_packages import find_moved_packages
from archgen.emit.workspace.own_code import rename_likely

WANTED = {
    "src/new_pkg/new_pkg/boss.py",
    "src/new_pkg/new_pkg/boss_contract.py",
    "src/eyes/include/eyes/finder_node.hpp",
    "src/eyes/include/eyes/finder_behaviour.hpp",
    "src/other/include/other/camera_node.hpp",
}


@pytest.mark.parametrize(
    ("path", "text", "expected"),
    [
        (
            "src/new_pkg/new_pkg/boss.py",
            "import os.path\nif X:\n    from old_pkg.boss_contract import BossPorts\nfrom geometry_msgs.msg import Twist\n",
            [(3, 10, "`old_pkg` has no `boss_contract` any more: it is `new_pkg` now")],
        ),
        ("src/new_pkg/new_pkg/boss.py", "from new_pkg.boss_contract import BossPorts\n", []),
        (
            "src/eyes/src/finder_behaviour.cpp",
            """#include "sight/finder_node.hpp"
#include "other/camera_node.hpp"
#include "std_msgs/msg/bool.hpp"
namespace sight
{
}  // namespace sight
namespace mine {}
""",
            [
                (1, 11, "`sight` has no `finder_node.hpp` any more: it is `eyes` now"),
                (4, 11, "what is generated is in another namespace: it is `eyes` now"),
            ],
        ),
    ],
)
def test_what_is_told(path: str, text: str, expected: list[tuple[int, int, str]]) -> None:
    found = list(find_moved_packages(path, text.encode(), WANTED))
    assert [(each.line, each.column, each.message) for each in found] == expected
    mended = rename_likely(path, text.encode(), found)
    assert not list(find_moved_packages(path, mended, WANTED))
