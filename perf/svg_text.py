"""A figure of matplotlib's as SVG text, to stand in a page or in a file of its own. With svg.fonttype none its text
stays text, and with a fixed svg.hashsalt the same numbers give the same bytes."""
import io
import re

import matplotlib.pyplot as plt

HEADER = '<?xml version="1.0" encoding="utf-8"?>\n'  # of a file


def svg_text(figure):
    """Closes the figure."""
    file = io.StringIO()
    figure.savefig(file, format='svg', metadata={'Date': None, 'Creator': None})
    plt.close(figure)
    svg = file.getvalue()
    svg = re.sub(r'<metadata>.*?</metadata>|<!--.*?-->', '', svg[svg.index('<svg'):], flags=re.DOTALL)
    # A hundredth of a point is enough of coordinates, which stand in tags; what is between them is text.
    return re.sub(r'<[^>]*>', lambda tag: re.sub(r'(\d+\.\d\d)\d+', r'\1', tag[0]), svg)
