"""Recordings of the running robot, held against the design: `archgen timing --measured`."""

PLUGIN = {
    "api": 1,
    "page": "docs/recordings.md",
    "readers": {"recordings": "archgen.plugins.recordings.recording_import:read_measured"},
}
