#!/usr/bin/env python3
"""Makes definition.pdf of README.md, down to its heading "Files and commands". Needs fpdf2 (pip install fpdf2).

It reads the Markdown of that page alone: headings, paragraphs, lists, tables, blocks of text, bold and code.
"""

import datetime
import re
from pathlib import Path

from fpdf import FPDF

HERE = Path(__file__).resolve().parent
SIZE, LINE = 8.1, 3.35


def marked(text):
    """Bold stays as fpdf2 writes it; code loses its marks, and names in italics would be read from underscores."""
    return re.sub(r"`([^`]*)`", r"\1", text)


def table(pdf, rows):
    cells = [[marked(cell.strip()) for cell in row.strip().strip("|").split("|")] for row in rows if not set(row) <= set("|-: ")]
    pdf.set_font("Helvetica", size=SIZE - 0.9)
    with pdf.table(col_widths=(13, 48, 40, 40, 53), line_height=LINE - 0.35, padding=(0.25, 0.6), borders_layout="HORIZONTAL_LINES",
                   text_align="LEFT", headings_style=None, first_row_as_headings=False) as lines:
        for row in cells:
            line = lines.row()
            for cell in row:
                line.cell(cell)
    pdf.ln(1)


def main():
    pdf = FPDF(format="A4")
    # The same bytes on every day.
    pdf.set_creation_date(datetime.datetime(2026, 1, 1, tzinfo=datetime.timezone.utc))
    pdf.set_title("The onset challenge, version 1")
    pdf.set_margins(13, 10, 13)
    pdf.set_auto_page_break(True, margin=9)
    pdf.add_page()
    lines = (HERE / "README.md").read_text().split("## Files and commands")[0].splitlines()
    while lines:
        line = lines.pop(0)
        if line.startswith("#"):
            level = len(line) - len(line.lstrip("#"))
            pdf.ln(0 if level == 1 else 0.8)
            pdf.set_font("Helvetica", "B", 14 if level == 1 else 10)
            pdf.multi_cell(0, 6 if level == 1 else 4.6, line.lstrip("# "), new_x="LMARGIN", new_y="NEXT")
        elif line.startswith("```"):
            block = []
            while not (line := lines.pop(0)).startswith("```"):
                block.append(line)
            pdf.set_font("Courier", size=SIZE - 0.6)
            pdf.multi_cell(0, LINE - 0.1, "\n".join(block), new_x="LMARGIN", new_y="NEXT")
            pdf.ln(0.8)
        elif line.startswith("|"):
            rows = [line]
            while lines and lines[0].startswith("|"):
                rows.append(lines.pop(0))
            table(pdf, rows)
        elif line:
            words = [line]
            while lines and lines[0] and not lines[0].startswith(("- ", "#", "|", "```")):
                words.append(lines.pop(0).strip())
            pdf.set_font("Helvetica", size=SIZE)
            pdf.set_x(pdf.l_margin + (2 if line.startswith("- ") else 0))
            pdf.multi_cell(0, LINE, marked(" ".join(words)), markdown=True, new_x="LMARGIN", new_y="NEXT")
            pdf.ln(0 if line.startswith("- ") else 0.7)
    pdf.output(HERE / "definition.pdf")


if __name__ == "__main__":
    main()
