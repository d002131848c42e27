"""What several folders need."""
