"""Changes of a source file, each behind a switch."""
import dataclasses
import re
import sys

SWITCH = ("#include <cstdlib>\n"
          "static inline bool IsMutant(int number) { static const char* const chosen = std::getenv(\"ARFM_VO_MUTANT\"); "
          "static const int mutant = chosen ? std::atoi(chosen) : 0; return mutant == number; }\n")
NUM_SWITCH_LINES = SWITCH.count("\n")
NUMBERS_A_FILE = 10000
INNER = "@@"


def render(line, start, end, changes):
    """The columns start..end of a line with all changes in them."""
    text, place = "", start
    outer = [change for change in changes if not any(other.holds(change) for other in changes)]
    for change in sorted(outer, key=lambda one: one.start):
        inside = [other for other in changes if change.holds(other)]
        text += line[place:change.start] + change.new.replace(INNER, render(line, *change.inner, inside))
        place = change.end
    return text + line[place:end]


@dataclasses.dataclass
class Change:
    number: int
    name: str
    file: str
    line: int
    text: str  # of the line
    rule: str = ""
    suites: tuple = ()
    # Of a change by a rule: the columns that it takes the place of, and of what is left of them, for which INNER stands.
    start: int = 0
    end: int = 0
    inner: tuple = (0, 0)
    new: str = ""

    def holds(self, other):
        return other is not self and self.start <= other.start and other.end <= self.end and \
            (self.start, self.end) != (other.start, other.end)


class Source:
    def __init__(self, root, file, index):
        self.path, self.file = root / file, file
        self.original = self.path.read_text()
        self.lines = self.original.split("\n")
        self.protected = []  # (text, its place taken by)
        self.by_rule = []
        self.next_number = index * NUMBERS_A_FILE + 1

    def _number(self):
        self.next_number += 1
        return self.next_number - 1

    def protect(self, protection):
        """A change that removes a protection; ends the program where its text is no longer there once."""
        if self.original.count(protection.old) != 1:
            sys.exit("%s: this must stand in %s once:\n%s" % (protection.name, self.file, protection.old))
        number = self._number()
        if protection.old.endswith(";"):
            switched = "if (IsMutant(%d)) { %s } else { %s }" % (number, protection.new, protection.old)
        else:
            switched = "(IsMutant(%d) ? (%s) : (%s))" % (number, protection.new, protection.old)
        self.protected.append((protection.old, switched))
        line = self.original[:self.original.index(protection.old)].count("\n") + 1
        return Change(number, protection.name, self.file, line, protection.old, suites=protection.suites)

    def add(self, rule, line, start, end, new, inner=None):
        """A change by a rule: the columns start..end of a line become `new`, which holds %d for the switch's number and
        INNER for the columns `inner` (the same where not given)."""
        number, text = self._number(), self.lines[line].strip()
        name = "%s:%d %s: %s" % (self.file.split("/")[-1], line + 1, rule, text)
        self.by_rule.append(Change(number, name, self.file, line + 1, text, rule, start=start, end=end,
                                   inner=inner or (start, end), new=new.replace("%d", str(number))))

    def drop_lines(self, numbers):
        """Gives up the changes of lines that do not compile; says whether there were any."""
        before = len(self.by_rule)
        lines = {number - NUM_SWITCH_LINES for number in numbers}
        self.by_rule = [change for change in self.by_rule if change.line not in lines]
        return len(self.by_rule) < before

    def write(self):
        if not self.by_rule and not self.protected:
            return self.restore()
        text = "\n".join(self._switched_lines())
        for old, switched in self.protected:
            text = text.replace(old, switched, 1)
        self.path.write_text(SWITCH + text)

    def _switched_lines(self):
        return [render(line, 0, len(line), [change for change in self.by_rule if change.line == number + 1])
                for number, line in enumerate(self.lines)]

    def restore(self):
        self.path.write_text(self.original)


def balanced(text, start):
    """The end of what the parenthesis at `start` encloses; nothing where it does not close in `text`."""
    depth = 0
    for i in range(start, len(text)):
        depth += {"(": 1, ")": -1}.get(text[i], 0)
        if depth == 0:
            return i
    return None


def strip_strings(line):
    """The line with the letters of its strings and its comment made blank."""
    line = re.sub(r'"(\\.|[^"\\])*"', lambda found: '"' + " " * (len(found.group()) - 2) + '"', line)
    return re.sub(r"//.*", lambda found: " " * len(found.group()), line)
