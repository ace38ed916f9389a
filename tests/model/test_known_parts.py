"""What is known of two versions: the first, and the one that had a part last."""

from archgen.model.known_parts import KnownParts


def test_the_first_part_stays_and_the_last_one_is_kept_beside_it() -> None:
    parts: KnownParts[str] = KnownParts()
    assert parts.list_known("camera") == ()
    parts.keep_part("camera", "of the project")
    assert parts.list_known("camera") == ("of the project",)
    for variant in ("of one variant", "of another"):
        parts.keep_part("camera", variant)
        assert parts.list_known("camera") == ("of the project", variant)
    assert parts.list_known("lidar") == ()
