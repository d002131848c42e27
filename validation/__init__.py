"""What is written in Python: tests of the plugin, renders, figures and benchmarks.

Each folder uses only those above it, no test is imported, and files form no circle: `cargo xtask tidy` refuses both.

| folder | holds |
| --- | --- |
| `data` | values of a peer, and what wrote them |
| `support` | what several folders need: paths, the core and the command, Mitsuba with the plugin, how pictures look |
| `error_budget` | the equations to 50 digits, and every stage's error against them |
| `figures` | the report's figures and what it says about them |
| `render` | the review set |
| `bench` | benchmarks |
| `tests` | tests, and what checks the plugin under other Mitsubas and with the address sanitizer |

Modules run from the repository's root, `.venv/bin/python -m validation.bench.compare` say.
"""
