"""What programs read: findings, timing and comparisons as JSON, SARIF, JUnit and GitHub annotations."""
