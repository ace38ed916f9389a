"""What linking remembers: indexes and names are found again where nothing of them changed."""

from archgen.link.link_memory import LinkMemory


def test_an_index_is_found_again_for_the_same_ids_alone() -> None:
    memory = LinkMemory()
    first = memory.index_paths("component", ["sensing.camera", "sensing.lidar"])
    assert first.ends["lidar"] == ["sensing.lidar"]
    assert memory.index_paths("component", ["sensing.camera", "sensing.lidar"]) is first
    other = memory.index_paths("component", ["sensing.camera"])
    assert "lidar" not in other.ends
    assert memory.index_paths("node", ["sensing.camera", "sensing.lidar"]) is not first
    assert memory.index_paths("component", ["sensing.camera", "sensing.lidar"]) is first


def test_names_are_the_same_object_where_no_name_came_or_went() -> None:
    memory = LinkMemory()
    names = memory.recall_names({"component": ["a.b"]}, {"host": ["pc"]})
    assert memory.recall_names({"component": ["a.b"]}, {"host": ["pc"]}) is names
    assert memory.recall_names({"component": ["a.b"]}, {"host": []}) is not names
