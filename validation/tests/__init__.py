"""Tests, and what checks the plugin under other Mitsubas and with the address sanitizer."""
