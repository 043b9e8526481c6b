#!/usr/bin/env python3
"""Makes definition.pdf of README.md, down to its heading "Files and commands". Needs fpdf2 (pip install fpdf2).

It reads the Markdown of that page alone: headings, paragraphs, lists, tables, blocks of text, bold and code.
"""

import datetime
import hashlib
import re
from pathlib import Path

HERE = Path(__file__).resolve().parent
MARGIN, SIZE, LINE = 14, 9.8, 4.35
MARKS = re.compile(r"(`[^`]*`|\*\*[^*]*\*\*)")


def definition():
    """The text of the two pages, and a hash of it, which stands in the subject of the PDF."""
    text = (HERE / "README.md").read_text().split("## Files and commands")[0]
    return text, hashlib.sha256(text.encode()).hexdigest()


def flow(pdf, text):
    """Writes a paragraph whose bold parts and code have fonts of their own."""
    for part in MARKS.split(text):
        code, bold = part.startswith("`"), part.startswith("**")
        pdf.set_font("Courier" if code else "Helvetica", "B" if bold else "", SIZE - (0.6 if code else 0))
        words = part.strip("`") if code else part.strip("*") if bold else part
        # A word is not divided where the font changes.
        if pdf.get_string_width(words.lstrip().split(" ")[0]) > pdf.w - pdf.r_margin - pdf.x - 3:
            pdf.ln(LINE)
            words = words.lstrip()
        pdf.write(LINE, words)
    pdf.ln(LINE)


def table(pdf, rows):
    cells = [[cell.strip() for cell in row.strip().strip("|").split("|")] for row in rows if not set(row) <= set("|-: ")]
    pdf.set_font("Helvetica", size=SIZE - 0.9)
    with pdf.table(col_widths=(14, 44, 38, 42, 44), line_height=LINE - 0.35, padding=(0.5, 0.7), borders_layout="HORIZONTAL_LINES",
                   text_align="LEFT", headings_style=None, first_row_as_headings=False) as lines:
        for number, row in enumerate(cells):
            pdf.set_font(style="B" if number == 0 else "")
            line = lines.row()
            for cell in row:
                line.cell(cell)
    pdf.ln(1)


def main():
    # Here, since a test without this package asks for the hash.
    from fpdf import FPDF

    pdf = FPDF(format="A4")
    # The same bytes on every day.
    pdf.set_creation_date(datetime.datetime(2026, 1, 1, tzinfo=datetime.timezone.utc))
    pdf.set_title("The onset challenge, version 1")
    text, checksum = definition()
    pdf.set_subject(checksum)
    pdf.set_margins(MARGIN, 14, MARGIN)
    pdf.set_auto_page_break(True, margin=12)
    pdf.add_page()
    lines = text.splitlines()
    while lines:
        line = lines.pop(0)
        if line.startswith("#"):
            level = len(line) - len(line.lstrip("#"))
            if line.endswith("Problems"):
                pdf.add_page()
            pdf.ln(0 if level == 1 else 0.8)
            pdf.set_font("Helvetica", "B", 15 if level == 1 else 11.5)
            pdf.multi_cell(0, 8 if level == 1 else 6, line.lstrip("# "), new_x="LMARGIN", new_y="NEXT")
        elif line.startswith("```"):
            block = []
            while not (line := lines.pop(0)).startswith("```"):
                block.append(line)
            pdf.set_font("Courier", size=SIZE - 1.7)
            pdf.multi_cell(0, LINE - 0.3, "\n".join(block), align="L", new_x="LMARGIN", new_y="NEXT")
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
            item = line.startswith("- ")
            pdf.set_left_margin(MARGIN + (3 if item else 0))
            flow(pdf, " ".join(words).removeprefix("- "))
            pdf.set_left_margin(MARGIN)
            pdf.ln(0.6 if item else 1.4)
    pdf.output(HERE / "definition.pdf")


if __name__ == "__main__":
    main()
