"""Colours that are told apart with every kind of colour vision: those of Okabe and Ito."""
import matplotlib

BLUE, ORANGE, GREEN, VERMILION, PURPLE, SKY, BLACK = (
    '#0072B2', '#E69F00', '#009E73', '#D55E00', '#CC79A7', '#56B4E9', '#000000')


def use():
    """From now on lines, bars and points take these colours in turn, as C0, C1 ... too."""
    matplotlib.rcParams['axes.prop_cycle'] = matplotlib.cycler(
        color=[BLUE, ORANGE, GREEN, VERMILION, PURPLE, SKY, BLACK])
