"""Changes that fixed rules make to a source: conditions, signs, limits, lines."""
import re

from switch import INNER, balanced, strip_strings

MUTANT = "IsMutant(%d)"
STATEMENT = re.compile(r"^\s+[a-z][\w.]*(->\w+)*(\(.*\)| [+-]?= .*);$")
FORBIDDEN = re.compile(r"^\s*(return|break|continue|case|using|Require|visit|#|//|\}|constexpr|static)")


def find_changes(source):
    for number, line in enumerate(source.lines):
        bare = strip_strings(line)
        if FORBIDDEN.match(bare) and not bare.lstrip().startswith("return"):
            continue
        change_conditions(source, number, line, bare)
        change_limits_and_signs(source, number, line, bare)
        change_returns(source, number, line, bare)
        if STATEMENT.match(bare) and bare.count("(") == bare.count(")") and is_whole(source, number):
            # (Braces outside, that an `else` that follows stays with its `if`.)
            source.add("line removed", number, 0, len(line), "{ if (!%s) { %s } }" % (MUTANT, INNER))


def is_whole(source, number):
    """Whether a statement begins on this line: the line before ends one, or opens a block, or is a condition's."""
    before = strip_strings(source.lines[number - 1]).rstrip()
    return before == "" or before[-1] in ";{}:" or (before.lstrip().startswith(("if (", "for (")) and before.endswith(")"))


def change_conditions(source, number, line, bare):
    for found in re.finditer(r"\bif \(", bare):
        start = found.end() - 1
        end = balanced(bare, start)
        if not end or re.match(r"(const |auto |constexpr )", line[start + 1:]):
            continue
        source.add("condition negated", number, start + 1, end, "%s != static_cast<bool>(%s)" % (MUTANT, INNER))
        return  # one condition a line; its parts below


def change_limits_and_signs(source, number, line, bare):
    if '"' in bare or "template" in bare or re.search(r"\bif \((?!const )", bare):
        return  # conditions are negated as a whole
    for found in re.finditer(r" [<>]=? (?=[a-zA-Z(1-9])", bare):
        source.add("limit doubled", number, found.start(), found.end(), INNER + "(%s ? 2 : 1) * " % MUTANT)
    for found in re.finditer(r" ([+-]) (?=[\w(])", bare):
        other = "-" if found.group(1) == "+" else "+"
        source.add("sign turned to " + other, number, found.start(), found.end(), INNER + "(%s ? -1 : 1) * " % MUTANT)
    for found in re.finditer(r"std::(min|max)\(", bare):
        end = balanced(bare, found.end() - 1)
        if end:
            other = {"min": "max", "max": "min"}[found.group(1)]
            source.add("std::%s turned to std::%s" % (found.group(1), other), number, found.start(), end + 1,
                       "(%s ? std::%s%s : %s%s)" % (MUTANT, other, INNER, found.group()[:-1], INNER), (found.end() - 1, end + 1))
            return


def change_returns(source, number, line, bare):
    found = re.match(r"^(?:.*\) )?\s*return (true|false);$", bare)
    if found:
        column = bare.rindex(found.group(1))
        other = {"true": "!%s", "false": "%s"}[found.group(1)] % MUTANT
        source.add("result turned round", number, column, column + len(found.group(1)), other)
    found = re.match(r"^\s+return ([^?;{]*(?: && | \|\| | == | != | <=? | >=? )[^?;{]*);$", bare)
    if found:
        source.add("result turned round", number, *found.span(1), "%s != static_cast<bool>(%s)" % (MUTANT, INNER))
