"""The report's figures and what it says about them."""
