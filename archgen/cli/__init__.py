"""The command line: one file for each verb. Parse the options, call the pipeline, print."""
