"""The equations to 50 digits, and every stage's error against them."""
