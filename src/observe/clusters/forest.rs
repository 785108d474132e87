//! Which of many things belong together, and whether they do so around a periodic box.

/// Disjoint trees with path halving, joined by size; every thing knows how many boxes it lies from its parent.
#[derive(Clone, Debug)]
pub(super) struct Forest {
    parents: Vec<u32>,
    /// `[thing]`: boxes from it to its parent.
    turns: Vec<[i32; 3]>,
    /// `[root]`: things in its tree.
    sizes: Vec<u32>,
    winds: [bool; 3],
}

impl Forest {
    /// `number` things, each alone.
    pub(super) fn new(number: usize) -> Self {
        Forest {
            parents: (0..number as u32).collect(),
            turns: vec![[0; 3]; number],
            sizes: vec![1; number],
            winds: [false; 3],
        }
    }

    /// Joins `a` with the image of `b` that lies `turns` boxes from the one inside.
    pub(super) fn join(&mut self, a: usize, b: usize, turns: [i32; 3]) {
        let (root_a, from_a) = self.root(a);
        let (root_b, from_b) = self.root(b);
        // From the root of a to that of b along this link.
        let way = minus(plus(turns, from_b), from_a);
        if root_a == root_b {
            for (winds, turns) in self.winds.iter_mut().zip(way) {
                *winds |= turns != 0;
            }
            return;
        }
        let (child, parent, way) = if self.sizes[root_a] < self.sizes[root_b] {
            (root_a, root_b, way)
        } else {
            (root_b, root_a, minus([0; 3], way))
        };
        self.parents[child] = parent as u32;
        self.turns[child] = way;
        self.sizes[parent] += self.sizes[child];
    }

    /// Sizes of all trees, in the order of their roots.
    pub(super) fn sizes(&self) -> Vec<u32> {
        let roots = self.parents.iter().enumerate().filter(|(thing, parent)| *thing == **parent as usize);
        roots.map(|(root, _)| self.sizes[root]).collect()
    }

    /// Things in the tree of `thing`, itself included.
    pub(super) fn size_with(&mut self, thing: usize) -> u32 {
        let (root, _) = self.root(thing);
        self.sizes[root]
    }

    /// Whether something is joined with its own image along an axis.
    pub(super) fn winds(&self) -> [bool; 3] {
        self.winds
    }

    /// The root of `thing`, and the boxes from it to the root.
    fn root(&mut self, mut thing: usize) -> (usize, [i32; 3]) {
        let mut total = [0; 3];
        loop {
            let parent = self.parents[thing] as usize;
            if parent == thing {
                return (thing, total);
            }
            let grandparent = self.parents[parent];
            self.turns[thing] = plus(self.turns[thing], self.turns[parent]);
            self.parents[thing] = grandparent;
            total = plus(total, self.turns[thing]);
            thing = grandparent as usize;
        }
    }
}

fn plus(a: [i32; 3], b: [i32; 3]) -> [i32; 3] {
    std::array::from_fn(|axis| a[axis] + b[axis])
}

fn minus(a: [i32; 3], b: [i32; 3]) -> [i32; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}
