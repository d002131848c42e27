"""The review set."""
