"""Checks a proof that stickslip's `prove` wrote, with nothing but Python's fractions.

    python3 check_proof.py PROOF.json [SYSTEM.json]        (PROOF.system.json if left out)

It does not ask how the proof was found. It reads the numbers of the system as the doubles they are, writes down what an
answer has to fulfil (docs/proofs.md), and goes through the proof: proved and exit status 0, or rejected, why, and 1.
"""

import json
import sys
from fractions import Fraction
from math import lcm


# -------- fractions and rows of them


def need(holds, why):
    if not holds:
        raise ValueError(why)


def exact(numbers):
    return [Fraction(float(number)) for number in numbers]


def dot(row, z):
    scale = lcm(*(x.denominator for x in z))  # whole numbers once, not in every product
    return sum((a * int(x * scale) for a, x in zip(row, z) if a and x), Fraction(0)) / scale


def without(row, other, at):
    """row less as much of other, whose entry there is 1, as leaves nothing there"""
    return [a - row[at] * b for a, b in zip(row, other)] if row[at] else row


def reduced(rows):
    """place -> row that is 1 there and 0 at the other places; a row takes the place of its largest entry, the first of
    such"""
    done = {}
    for row in rows:
        for at, other in done.items():
            row = without(row, other, at)
        at = max((j for j in range(len(row)) if j not in done), key=lambda j: abs(row[j]), default=0)
        if row[at]:
            row = [a / row[at] for a in row]
            done = {place: without(other, row, at) for place, other in done.items()} | {at: row}
    return done


# -------- answers: a problem is a list of forms, affine in its unknowns; what is claimed is about their signs


def holds(values, zero, signs):
    return all(values[name] == 0 for name in zero) and all(s * values[name] >= 0 for name, s in signs.items())


class Problem:
    """forms: name -> coefficients over the unknowns and 1; of these signed ones are >= 0, zero ones 0, and of every group
    one branch holds: names that are 0, and a displacement with its sign"""

    def __init__(self, unknowns):
        self.unknowns, count = unknowns, len(unknowns)
        self.forms = {name: [Fraction(i == j) for j in range(count + 1)] for i, name in enumerate(unknowns)}
        self.signed, self.zero, self.groups = set(), set(), {}

    def read(self, given):
        """values of an answer, every one of them recomputed from the unknowns"""
        need(set(given) == set(self.forms), "values are missing, or of nothing")
        values = {name: Fraction(text) for name, text in given.items()}
        z = [values[name] for name in self.unknowns] + [Fraction(1)]
        for name, form in self.forms.items():
            need(values[name] == dot(form, z), f"{name} is not what it says")
            need(values[name] >= 0 or name not in self.signed, f"{name} < 0")
            need(values[name] == 0 or name not in self.zero, f"{name} is not 0")
        for group, branches in self.groups.items():
            need(any(holds(values, *branch) for branch in branches.values()), f"no branch of {group} holds")
        return values

    def total(self, factors, zero, signs):
        """what a sum is whatever the unknowns; none of its terms can be negative"""
        row = [Fraction(0)] * (len(self.unknowns) + 1)
        for name, text in factors.items():
            factor = Fraction(text)
            need(name in zero or factor * signs.get(name, 0) > 0, f"the factor of {name} has no such sign")
            row = [a + factor * b for a, b in zip(row, self.forms[name])]
        need(not any(row[:-1]), "the sum depends on the unknowns")
        return row[-1]

    def tree(self, node, answers, zero, signs):
        """goes through all branches; the number of ends that are sets of answers"""
        if set(node) == {"of", "branches"}:
            branches = self.groups[node["of"]]
            need(set(branches) == set(node["branches"]), f"branches of {node['of']} are missing")
            below = [(node["branches"][name], *branches[name]) for name in branches]
            return sum(self.tree(child, answers, zero | more, signs | sign) for child, more, sign in below)
        if set(node) == {"cut"}:
            need(self.total(node["cut"], zero, signs) < 0, "a cut is not a contradiction")
            return 0
        here = [node["answer"]] if set(node) == {"answer", "tight"} else node["set"]
        need(set(node) in ({"answer", "tight"}, {"set"}) and here, "an end that is none")
        for number in here:
            need(type(number) is int and 1 <= number <= len(answers), "no such answer")
            need(holds(answers[number - 1], zero, signs), f"answer {number} is not in this branch")
        if "set" in node:
            return 1
        need(self.total(node["tight"], zero, signs) == 0, "a sum that is not 0")
        held = zero | {name for name, factor in node["tight"].items() if Fraction(factor)}
        alone = len(reduced(self.forms[name][:-1] for name in held)) == len(self.unknowns)
        need(alone, "an answer that is not alone")
        return 0


# -------- an LCP


def of_lcp(lcp):
    names, M, q = lcp["names"], [exact(row) for row in lcp["M"]], exact(lcp["q"])
    need(len(set(names)) == len(names) == len(M) == len(q) and all(len(row) == len(q) for row in M), "M, q or names")
    problem = Problem([f"z {name}" for name in names])
    problem.forms |= {f"w {name}": row + [constant] for name, row, constant in zip(names, M, q)}
    problem.groups = {name: {letter: ({f"{letter} {name}"}, {}) for letter in "zw"} for name in names}
    problem.signed = set(problem.forms)
    return problem


# -------- pairs


def of_contact(system, proof):
    """the load, the laws, R and what the proof needs of them: a motion in the kernel needs no forms, and one on Coulomb's
    cone has none"""
    ids, (load,), tangents = system["pairs"], system["loads"].values(), system.get("tangents", 1)
    words, m, size = ["t"] if tangents == 1 else ["t1", "t2"], len(ids), (1 + tangents) * len(ids)
    R, kernel = [exact(row) for row in system["stiffness"]], [exact(z) for z in system.get("kernel", [])]
    vector = exact(load["vector"])
    need(tangents in (1, 2) and len(set(ids)) == m and len(R) == size, "the size of the system")
    need(all(len(z) == size for z in R + kernel + [vector]), "the size of R, its kernel or the load")
    need(all(R[i][j] == R[j][i] for i in range(size) for j in range(i)), "R is not symmetric")
    need(load["factor"] == 1, "the factor of the load")
    friction, cohesion, bound, gaps = (exact(system[key]) for key in ("friction", "cohesion", "bound", "gap"))
    slips = {name: [f"z_{word} {name}" for word in words] for name in ids}
    problem = Problem([f"z_n {name}" for name in ids] + sum(slips.values(), []))
    problem.slips, problem.load, problem.kernel = slips, vector, kernel
    problem.laws = list(zip(ids, system["law"], friction, map(sum, zip(cohesion, bound))))
    need(len(problem.laws) == m == len(gaps) and min(friction) >= 0, "the laws")
    need(all(law in ("coulomb", "frictionless", "bound") and c >= 0 for _, law, _, c in problem.laws), "a law")
    problem.directions = facets(proof["directions"]) if tangents == 2 and "directions" in proof else None
    if proof.get("amounts"):
        return problem
    problem.R = stiffness(R, kernel)
    if tangents == 2 and problem.directions is None:
        need(proof["claim"] == "collapse", "no directions")
        return problem
    force = [row + [q - dot(row[:m], gaps)] for row, q in zip(problem.R, vector)]
    for i, law in enumerate(problem.laws):
        pair(problem, law, force[i], force[m + tangents * i : m + tangents * (i + 1)])
    return problem


def pair(problem, law, normal, tangential):
    """the forms of a pair from those of its forces, their signs, and what it can do"""
    name, law, f, c = law
    z_n, x_n, z_t = f"z_n {name}", f"x_n {name}", problem.slips[name]
    problem.forms[x_n] = normal
    if law == "bound":
        problem.zero.add(z_n)
    else:
        problem.signed |= {z_n, x_n}
    if law == "frictionless":
        for slip, row in zip(z_t, tangential):
            force = slip.replace("z", "x", 1)
            problem.forms[force] = row
            problem.zero |= {force} if any(row[:-1]) else {force, slip}
        problem.groups[name] = {"closed": ({z_n}, {}), "open": ({x_n}, {})}
        return
    bound = [f * a for a in normal]
    bound[-1] += c
    ways, held_by_nothing = (plane if len(z_t) == 1 else space)(problem, name, bound, tangential, z_t)
    if law == "bound" and not any(bound) and not any(any(row[:-1]) for row in tangential):
        # it rolls, and no force feels how far
        problem.zero |= set(z_t)
        ways = {"stick": ways["stick"]}
    of = lambda word, on: {word + way: ({on} | zero, signs) for way, (zero, signs) in ways.items()}
    free = {"open": ({x_n} | held_by_nothing, {})}
    problem.groups[name] = of("", z_n) | ({} if law == "bound" else of("open ", x_n) if c else free)


def plane(problem, name, bound, tangential, z_t):
    """x+, x- and the slips along t: what a closed pair can do, and the forms that are zero where nothing holds it"""
    plus, minus, z_t, tangential = f"x+ {name}", f"x- {name}", *z_t, *tangential
    for reserve, side in ((plus, 1), (minus, -1)):
        problem.forms[reserve] = [a + side * b for a, b in zip(bound, tangential)]
    problem.signed |= {plus, minus}
    return {"stick": ({z_t}, {}), "slip+": ({plus}, {z_t: 1}), "slip-": ({minus}, {z_t: -1})}, {plus, minus}


# -------- collapse


def collapse(problem, proof):
    """a motion without energy that presses no pair, on which the loads do more than contact can take"""
    motion = {name: Fraction(text) for name, text in proof["motion"].items()}
    amounts = [Fraction(text) for text in proof["amounts"]]
    need(set(motion) == set(problem.unknowns) and len(amounts) in (0, len(problem.kernel)), "the motion or its amounts")
    z = [motion[name] for name in problem.unknowns]
    if amounts:
        need(all(x == dot(column, amounts) for x, column in zip(z, zip(*problem.kernel))), "the motion is not of the kernel")
    else:
        need(not any(dot(row, z) for row in problem.R), "the motion costs energy")
    slips = {name: reach(problem, name, motion, proof.get("slips")) for name in problem.slips}
    for name, law, f, c in problem.laws:
        part, f = motion[f"z_n {name}"], 0 if law == "frictionless" else f
        need(part == 0 if law == "bound" else part >= f * slips[name], f"the motion presses pair {name}")
    work = -dot(problem.load, z)
    bound = sum(c * slips[name] for name, law, _, c in problem.laws if law != "frictionless")
    need((work, bound) == (Fraction(proof["work"]), Fraction(proof["bound"])) and work > bound, "the work or its bound")
    does = f"the loads do {float(work):.6g}, contact takes at most {float(bound):.6g}"
    return f"collapse: on this motion {does}; no answer"


def reach(problem, name, motion, slips):
    """what counts as |slip| of a pair: in the plane its size, in space a bound of it from above that the proof gives"""
    z = [motion[slip] for slip in problem.slips[name]]
    if len(z) == 1:
        return abs(z[0])
    need(reaches(problem.directions, z, Fraction(slips[name])), f"{name} slips farther than it says")
    return Fraction(slips[name])


# -------- parts that only contact holds


def stiffness(R, kernel):
    """R with the motions of the kernel as such to the last digit: [1 -G]' R_NN [1 -G], where the motions are [G; 1]"""
    own, R = reduced(kernel), [list(row) for row in R]
    rest = [j for j in range(len(R)) if j not in own]
    for p, z in own.items():
        for n in rest:
            R[n][p] = R[p][n] = -sum(R[n][j] * z[j] for j in rest if z[j])
    for p, z in own.items():
        for q in own:
            R[p][q] = -sum(z[j] * R[j][q] for j in rest if z[j])
    return R


# -------- in space


def facets(half):
    """the directions of a polygon from those that are not mirrors: in order around, together a half turn"""
    half = [tuple(map(Fraction, direction)) for direction in half]
    around = half + [(-a, -b) for a, b in half]
    turns = all(cross(d, e) > 0 for d, e in zip(around, around[1:]))
    need(len(half) >= 2 and turns, "the directions are not in order around")
    need(all(abs(a * a + b * b - 1) < Fraction(1, 10**15) for a, b in around), "a direction whose length is not 1")
    return around


def cross(d, e):
    return d[0] * e[1] - d[1] * e[0]


def space(problem, name, bound, tangential, z_t):
    """the same on a polygon: x^k of its facets, turn^k = d_k cross z_t"""
    count = len(problem.directions)
    x = lambda k: f"x^{k % count} {name}"
    for k, d in enumerate(problem.directions):
        problem.forms[x(k)] = [a + d[0] * b + d[1] * e for a, b, e in zip(bound, *tangential)]
        problem.signed.add(x(k))
    for k, d in enumerate(problem.directions[: count // 2]):
        problem.forms[f"turn^{k} {name}"] = [d[0] * b - d[1] * a for a, b in zip(*(problem.forms[z] for z in z_t))]
    turn = lambda k: (f"turn^{k % (count // 2)} {name}", 1 if k % count < count // 2 else -1)
    ways = {"stick": (set(z_t), {})}
    for k in range(count):
        ways[f"slip^{k}"] = {x(k), turn(k)[0]}, dict([turn(k - 1)])
        (here, up), (there, down) = turn(k), turn(k + 1)
        ways[f"slip^{k}^{(k + 1) % count}"] = {x(k), x(k + 1)}, {here: up, there: -down}
    return ways, {x(0), x(1)}


def reaches(directions, z, most):
    """whether a slip counts as no more than this: on Coulomb's cone, or on the polygon, where z = a d + b e counts a + b"""
    if directions is None:
        return most >= 0 and most**2 >= z[0] ** 2 + z[1] ** 2
    pairs = zip(directions, directions[1:] + directions[:1])
    parts = [(cross(z, e) / cross(d, e), cross(d, z) / cross(d, e)) for d, e in pairs]
    return any(a >= 0 and b >= 0 and a + b <= most for a, b in parts)


# -------- the files


def check(proof, system):
    """the sentence that is proved; raises where it is not"""
    parts = {
        "answer": {"scheme", "values"},
        "answers": {"answers", "tree"},
        "collapse": {"motion", "amounts", "work", "bound"},
    }
    keys = {"format", "system", "claim"} | parts[proof["claim"]]
    need(keys <= set(proof) <= keys | {"directions", "slips"}, "a key is missing, or one too many")
    need(proof["format"] == "stickslip-proof/1", "another format")
    problem = of_lcp(system["lcp"]) if "lcp" in system else of_contact(system["contact_system"], proof)
    if proof["claim"] == "collapse":
        return collapse(problem, proof)
    if proof["claim"] == "answer":
        values = problem.read(proof["values"])
        need(set(proof["scheme"]) == set(problem.groups), "the scheme")
        for group, word in proof["scheme"].items():
            need(holds(values, *problem.groups[group][word]), f"{group} is not {word}")
        return f"an answer: the values of {len(values)} quantities, every sign"
    answers = [problem.read(values) for values in proof["answers"]]
    different = {tuple(values[name] for name in problem.unknowns) for values in answers}
    need(len(different) == len(answers), "an answer twice")
    sets = problem.tree(proof["tree"], answers, problem.zero, dict.fromkeys(problem.signed, 1))
    if sets:
        return f"every answer is one of {len(answers)} or lies in one of {sets} sets, each with some of these in it"
    return f"the number of answers is {len(answers)}, and these are all" if answers else "there is no answer"


def of_text(proof, system):
    """both files as bytes"""
    name = 0x6C62272E07BB014262B821756295C58D  # FNV-1a, 128 bits
    for byte in system:
        name = (name ^ byte) * 0x0000000001000000000000000000013B % 2**128
    proof = json.loads(proof)
    need(proof["system"] == f"{name:032x}", "the proof is about another system")
    return check(proof, json.loads(system))


sys.set_int_max_str_digits(0)  # fractions are as long as they are

if __name__ == "__main__":
    files = sys.argv[1:] if len(sys.argv) > 2 else [*sys.argv[1:], sys.argv[-1].removesuffix(".json") + ".system.json"]
    try:
        print("proved:", of_text(*(open(file, "rb").read() for file in files)))
    except (ValueError, KeyError, TypeError, AttributeError, IndexError, ArithmeticError, RecursionError, OSError) as error:
        sys.exit(f"rejected: {error}")
