"""What every stage reports: diagnostics with their rule, severity and place, and the words that quote user text safely."""
