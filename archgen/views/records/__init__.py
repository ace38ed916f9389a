"""The model as plain data for other programs: `resolved_record.py` puts together what the others make of each kind."""
