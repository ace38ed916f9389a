"""The first stage: exact values that say what they lack, and how they are worded."""
