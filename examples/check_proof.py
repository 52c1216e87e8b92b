"""Checks a proof that stickslip's `prove` wrote, with nothing but Python's fractions.

    python3 check_proof.py PROOF.json [SYSTEM.json]        (PROOF.system.json if left out)

It does not ask how the proof was found. It reads the numbers of the system as the doubles they are, writes down what an
answer has to fulfil (docs/proofs.md), and goes through the proof: proved and exit status 0, or rejected, why, and 1.
"""

import json
import sys
from fractions import Fraction
from math import lcm


def need(holds, why):
    if not holds:
        raise ValueError(why)


def exact(number):
    need(type(number) in (int, float), f"{number!r} is no number")
    return Fraction(float(number))


def fraction(text):
    need(type(text) is str, f"{text!r} is no fraction in quotes")
    return Fraction(text)


def dot(row, z):
    scale = lcm(*(x.denominator for x in z))  # whole numbers once, not in every product
    return sum((a * int(x * scale) for a, x in zip(row, z) if a and x), Fraction(0)) / scale


def without(row, other, at):
    """row less as much of other, whose entry there is 1, as leaves nothing there"""
    return [a - row[at] * b for a, b in zip(row, other)] if row[at] else row


def rank(rows):
    done = []
    for row in rows:
        for at, other in done:
            row = without(row, other, at)
        at = next((j for j, a in enumerate(row) if a), None)
        if at is not None:
            done.append((at, [a / row[at] for a in row]))
    return len(done)


def stiffness(R, kernel):
    """R with the motions of the kernel as such to the last digit: each takes its largest joint P, and R means
    [1 -G]' R_NN [1 -G] over the other joints N, where the motions are [G; 1]"""
    reduced = {}
    for z in kernel:
        for p, known in reduced.items():
            z = without(z, known, p)
        p = max((j for j in range(len(R)) if j not in reduced), key=lambda j: abs(z[j]))
        if z[p]:
            z = [a / z[p] for a in z]
            reduced = {q: without(known, z, p) for q, known in reduced.items()} | {p: z}
    rest = [j for j in range(len(R)) if j not in reduced]
    R = [list(row) for row in R]
    for p, z in reduced.items():
        for n in rest:
            R[n][p] = R[p][n] = -sum(R[n][j] * z[j] for j in rest if z[j])
    for p, z in reduced.items():
        for q in reduced:
            R[p][q] = -sum(z[j] * R[j][q] for j in rest if z[j])
    return R


class Problem:
    """forms: name -> (coefficients over the unknowns, constant); of these signed ones are >= 0, zero ones 0, and of
    every group one branch holds: names that are 0, and a displacement with its sign"""

    def __init__(self, unknowns):
        unit = lambda i: [Fraction(i == j) for j in range(len(unknowns))]
        self.unknowns, self.forms = unknowns, {name: (unit(i), Fraction(0)) for i, name in enumerate(unknowns)}
        self.signed, self.zero, self.groups = set(), set(), {}

    def value(self, name, z):
        return dot(self.forms[name][0], z) + self.forms[name][1]

    def holds(self, values, zero, signs):
        return all(values[name] == 0 for name in zero) and all(s * values[name] >= 0 for name, s in signs.items())

    def read(self, given):
        """values of an answer, every one of them recomputed from the unknowns"""
        need(set(given) == set(self.forms), "values are missing, or of nothing")
        values = {name: fraction(text) for name, text in given.items()}
        z = [values[name] for name in self.unknowns]
        for name in self.forms:
            need(values[name] == self.value(name, z), f"{name} is not what it says")
            need(name not in self.signed or values[name] >= 0, f"{name} < 0")
            need(name not in self.zero or values[name] == 0, f"{name} is not 0")
        for group, branches in self.groups.items():
            need(any(self.holds(values, *branch) for branch in branches.values()), f"no branch of {group} holds")
        return values

    def total(self, factors, zero, signs):
        """a sum that cannot be negative: coefficients of the unknowns, constant"""
        row, constant = [Fraction(0)] * len(self.unknowns), Fraction(0)
        for name, text in factors.items():
            factor, (form, own) = fraction(text), self.forms[name]
            need(name in zero or factor * signs.get(name, 0) > 0, f"the factor of {name} has no such sign")
            row, constant = [a + factor * b for a, b in zip(row, form)], constant + factor * own
        need(not any(row), "the sum depends on the unknowns")
        return constant

    def tree(self, node, answers, zero, signs):
        """goes through all branches; the numbers of its sets of answers"""
        if set(node) == {"of", "branches"}:
            branches = self.groups[node["of"]]
            need(set(branches) == set(node["branches"]), f"branches of {node['of']} are missing")
            below = [(node["branches"][name], *branches[name]) for name in branches]
            return sum(self.tree(child, answers, zero | more, signs | sign) for child, more, sign in below)
        if set(node) == {"cut"}:
            need(self.total(node["cut"], zero, signs) < 0, "a cut is no contradiction")
            return 0
        here = [node["answer"]] if set(node) == {"answer", "tight"} else node["set"]
        need(set(node) in ({"answer", "tight"}, {"set"}) and here, "an end that is none")
        for number in here:
            need(type(number) is int and 1 <= number <= len(answers), "no such answer")
            need(self.holds(answers[number - 1], zero, signs), f"answer {number} is not in this branch")
        if "set" in node:
            return 1
        need(self.total(node["tight"], zero, signs) == 0, "a sum that is not 0")
        held = zero | {name for name, factor in node["tight"].items() if fraction(factor)}
        need(rank([self.forms[name][0] for name in held]) == len(self.unknowns), "an answer that is not alone")
        return 0


def of_lcp(lcp):
    names, M, q = lcp["names"], lcp["M"], [exact(x) for x in lcp["q"]]
    problem = Problem([f"z {name}" for name in names])
    need(len(set(names)) == len(names) == len(M) == len(q) and all(len(row) == len(q) for row in M), "M, q or names")
    for name, row, constant in zip(names, M, q):
        problem.forms[f"w {name}"] = [exact(x) for x in row], constant
        problem.groups[name] = {letter: ({f"{letter} {name}"}, {}) for letter in "zw"}
    problem.signed = set(problem.forms)
    return problem


def of_contact(system, of_kernel):
    """of_kernel: only what the proof of a motion in the kernel needs"""
    ids, m = system["pairs"], len(system["pairs"])
    R = [[exact(x) for x in row] for row in system["stiffness"]]
    need(len(set(ids)) == m and len(R) == 2 * m and all(len(row) == 2 * m for row in R), "the size of the system")
    need(all(R[i][j] == R[j][i] for i in range(2 * m) for j in range(i)), "R is not symmetric")
    kernel = [[exact(x) for x in z] for z in system.get("kernel", [])]
    (load,) = system["loads"].values()
    need(load["factor"] == 1 and all(len(z) == 2 * m for z in kernel + [load["vector"]]), "the load or the kernel")
    numbers = {key: [exact(x) for x in system[key]] for key in ("friction", "cohesion", "bound", "gap")}
    problem = Problem([f"{word} {name}" for word in ("z_n", "z_t") for name in ids])
    problem.load, problem.kernel = [exact(x) for x in load["vector"]], kernel
    problem.laws = list(zip(ids, system["law"], numbers["friction"], map(sum, zip(numbers["cohesion"], numbers["bound"]))))
    need(len(problem.laws) == m == len(numbers["gap"]) and min(numbers["friction"]) >= 0, "the laws")
    need(all(law in ("coulomb", "frictionless", "bound") and c >= 0 for _, law, _, c in problem.laws), "a law")
    if of_kernel:
        return problem
    problem.R = stiffness(R, kernel)
    force = [(row, q - dot(row[:m], numbers["gap"])) for row, q in zip(problem.R, problem.load)]
    for i, (name, law, f, c) in enumerate(problem.laws):
        z_n, z_t, x_n, x_t, plus, minus = (f"{word} {name}" for word in ("z_n", "z_t", "x_n", "x_t", "x+", "x-"))
        (normal, n), (tangential, t) = force[i], force[m + i]
        problem.forms[x_n] = normal, n
        if law == "bound":
            problem.zero.add(z_n)
        else:
            problem.signed |= {z_n, x_n}
        if law == "frictionless":
            problem.forms[x_t] = tangential, t
            problem.zero |= {x_t} if any(tangential) else {x_t, z_t}
            problem.groups[name] = {"closed": ({z_n}, {}), "open": ({x_n}, {})}
            continue
        problem.forms[plus] = [f * a + b for a, b in zip(normal, tangential)], f * n + c + t
        problem.forms[minus] = [f * a - b for a, b in zip(normal, tangential)], f * n + c - t
        problem.signed |= {plus, minus}
        three = lambda word, on: {f"{word}stick": ({on, z_t}, {}), f"{word}slip+": ({on, plus}, {z_t: 1}), f"{word}slip-": ({on, minus}, {z_t: -1})}
        free = {"open": ({x_n, plus, minus}, {})}
        problem.groups[name] = three("", z_n) | ({} if law == "bound" else three("open ", x_n) if c else free)
    return problem


def check(proof, system):
    """the sentence that is proved; raises where it is not"""
    need(proof["format"] == "stickslip-proof/1", "another format")
    of_kernel = bool(proof.get("amounts"))
    problem = of_lcp(system["lcp"]) if "lcp" in system else of_contact(system["contact_system"], of_kernel)
    expected = {"answer": {"scheme", "values"}, "answers": {"answers", "tree"}, "collapse": {"motion", "amounts", "work", "bound"}}
    need(set(proof) == {"format", "system", "claim"} | expected[proof["claim"]], "another form")
    if proof["claim"] == "answer":
        values = problem.read(proof["values"])
        need(set(proof["scheme"]) == set(problem.groups), "the scheme")
        for group, word in proof["scheme"].items():
            need(problem.holds(values, *problem.groups[group][word]), f"{group} is not {word}")
        return f"an answer: the values of {len(values)} quantities, every sign"
    if proof["claim"] == "answers":
        answers = [problem.read(values) for values in proof["answers"]]
        need(len({tuple(values[name] for name in problem.unknowns) for values in answers}) == len(answers), "an answer twice")
        sets = problem.tree(proof["tree"], answers, problem.zero, dict.fromkeys(problem.signed, 1))
        if sets:
            return f"every answer is one of {len(answers)} or lies in one of {sets} sets with these as corners"
        return f"the number of answers is {len(answers)}, and these are all" if answers else "there is no answer"
    motion = {name: fraction(text) for name, text in proof["motion"].items()}
    need(set(motion) == set(problem.unknowns), "the motion")
    z, amounts = [motion[name] for name in problem.unknowns], [fraction(text) for text in proof["amounts"]]
    if amounts:
        need(len(amounts) == len(problem.kernel), "the amounts")
        need(all(x == dot(column, amounts) for x, column in zip(z, zip(*problem.kernel))), "the motion is not of the kernel")
    else:
        need(not any(dot(row, z) for row in problem.R), "the motion costs energy")
    for name, law, f, c in problem.laws:
        part, slip = motion[f"z_n {name}"], abs(motion[f"z_t {name}"])
        need(part == 0 if law == "bound" else part >= f * slip, f"the motion presses pair {name}")
    work, bound = -dot(problem.load, z), sum(c * abs(motion[f"z_t {name}"]) for name, law, _, c in problem.laws if law != "frictionless")
    need((work, bound) == (fraction(proof["work"]), fraction(proof["bound"])), "the work or its bound")
    need(work > bound, "the loads do no more than contact can take")
    return f"collapse: on this motion the loads do {float(work):.6g}, contact takes at most {float(bound):.6g}; no answer"


def of_text(proof, system):
    """both files as bytes"""

    def once(entries):
        need(len(dict(entries)) == len(entries), "a key that stands twice")
        return dict(entries)

    name = 0x6C62272E07BB014262B821756295C58D  # FNV-1a, 128 bits
    for byte in system:
        name = (name ^ byte) * 0x0000000001000000000000000000013B % 2**128
    proof = json.loads(proof, object_pairs_hook=once)
    need(proof["system"] == f"{name:032x}", "the proof is about another system")
    return check(proof, json.loads(system, object_pairs_hook=once))


sys.set_int_max_str_digits(0)  # fractions are as long as they are

if __name__ == "__main__":
    files = sys.argv[1:] if len(sys.argv) > 2 else [*sys.argv[1:], sys.argv[-1].removesuffix(".json") + ".system.json"]
    try:
        print("proved:", of_text(*(open(file, "rb").read() for file in files)))
    except (ValueError, KeyError, TypeError, AttributeError, IndexError, ArithmeticError, RecursionError, OSError) as error:
        sys.exit(f"rejected: {error}")
