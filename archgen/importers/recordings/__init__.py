"""Recordings of the running robot to observations: traces, CARET's tables, logs of `ros2 topic`, metadata of bags."""
