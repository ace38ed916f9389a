"""Recordings of the running robot, held against the design: `archgen timing --measured`, `archgen conform`."""

PLUGIN = {
    "api": 1,
    "page": "docs/recordings.md",
    "readers": {"recordings": "archgen.plugins.recordings.recording_import:read_measured"},
    "observers": {
        "trace": {
            "rank": 2,
            "summary": "a trace of ros2_tracing as babeltrace2 prints it",
            "reader": "archgen.plugins.recordings.trace_events:observe_trace",
        },
        "recording": {
            "rank": 2,
            "summary": "a recording: the folder of a bag, its metadata.yaml, .mcap, .db3, or .bag of ROS 1",
            "reader": "archgen.plugins.recordings.bag_observation:observe_recording",
        },
    },
}
