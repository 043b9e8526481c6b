"""Writes the widths and outlines of a font's characters: python3 outlines.py FONT.ttf > outlines.txt (see README.md)."""

import sys

from fontTools.pens.basePen import BasePen
from fontTools.ttLib import TTFont


class OutlinePen(BasePen):
    """Writes a glyph as the path of an SVG: M (move), L (line), Q (quadratic curve) and Z (close)."""

    def __init__(self, glyphs):
        super().__init__(glyphs)
        self.commands = []

    def add(self, command, *points):
        self.commands.append(command + ",".join(f"{number:g}" for point in points for number in point))

    def _moveTo(self, point):
        self.add("M", point)

    def _lineTo(self, point):
        self.add("L", point)

    def _qCurveToOne(self, control, point):
        self.add("Q", control, point)

    def _closePath(self):
        self.add("Z")


font = TTFont(sys.argv[1])
glyphs = font.getGlyphSet()


def line(character, name):
    pen = OutlinePen(glyphs)
    glyphs[name].draw(pen)
    return " ".join([character, str(glyphs[name].width), *pen.commands])


print(line("missing", ".notdef"))
for code, name in sorted(font.getBestCmap().items()):
    print(line(f"{code:x}", name))
