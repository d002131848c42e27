"""The page of the report's figures: one static file beside the pictures and their data."""

from collections.abc import Iterable
from html import escape
from typing import NamedTuple

from validation.figures.claim import Claim, Figure, Verdict
from validation.support.look import PAGE


class Result(NamedTuple):
    """A figure with the verdicts on its claims, the names of its files and the size of its picture in pixels."""

    figure: Figure
    verdicts: list[Verdict]
    tables: list[str]
    size: tuple[int, int]


def page(results: list[Result], facts: str) -> str:
    """The whole page."""
    sections = "".join(section(result) for result in results)
    return (
        "<!DOCTYPE html>\n<html lang='en'>\n<head>\n<meta charset='utf-8'>\n"
        "<meta name='viewport' content='width=device-width, initial-scale=1'>\n"
        f"<title>prob-water: the report's figures</title>\n<style>{PAGE}</style>\n</head>\n<body>\n"
        "<h1>The report's figures</h1>\n"
        "<p>The figures of AFRL-RH-FS-TR-2023-0002 as this implementation computes them. The report's own pictures "
        "are not at hand; what its text says about them is quoted, checked against the data and listed "
        "<a href='#summary'>at the end</a>. Brackets are ours. Statements in italics are ours, not the report's. "
        "A statistical claim holds where it does so by more than 4 standard errors.</p>\n"
        f"<p>{escape(facts)}</p>\n{sections}{summary(results)}</body>\n</html>\n"
    )


def section(result: Result) -> str:
    """One figure: picture, caption, claims and data."""
    figure, (width, height) = result.figure, result.size
    links = ", ".join(f"<a href='data/{name}'>{name}</a>" for name in result.tables)
    rows = (row(claim, verdict) for claim, verdict in zip(figure.claims, result.verdicts, strict=True))
    return (
        f"<section id='{figure.name}'>\n<h2>{escape(figure.title)}</h2>\n"
        f"<img src='{figure.name}.png' width='{width}' height='{height}' alt='{escape(figure.title)}'>\n"
        f"<p>{escape(figure.caption)}</p>\n{table(['claim', '', 'numbers'], rows)}"
        f"<p>Data: {links}</p>\n</section>\n"
    )


def summary(results: list[Result]) -> str:
    """All claims in one table."""
    rows = (f"<td><a href='#{result.figure.name}'>{escape(result.figure.title.split(':')[0])}</a></td>"
            + row(claim, verdict)
            for result in results for claim, verdict in zip(result.figure.claims, result.verdicts, strict=True))
    return f"<section id='summary'>\n<h2>Summary</h2>\n{table(['figure', 'claim', '', 'numbers'], rows)}</section>\n"


def row(claim: Claim, verdict: Verdict) -> str:
    """The cells of a claim."""
    text = f"<span class='own'>{escape(claim.text)}</span>" if claim.own else f"“{escape(claim.text)}”"
    kind, word = ("holds", "holds") if verdict.holds else ("fails", "does not hold")
    return (f"<td class='claim'>{text}</td><td class='verdict {kind}'>{word}</td>"
            f"<td>{escape(verdict.numbers)}</td>")


def table(names: list[str], rows: Iterable[str]) -> str:
    """An HTML table of rows of cells."""
    head = "".join(f"<th>{name}</th>" for name in names)
    return f"<table>\n<tr>{head}</tr>\n" + "".join(f"<tr>{cells}</tr>\n" for cells in rows) + "</table>\n"
