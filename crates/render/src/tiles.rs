//! Cuts a picture into tiles whose size adapts to the time that they take.

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tile {
    /// Its first column and row.
    pub origin: [u32; 2],
    /// Its columns and rows.
    pub size: [u32; 2],
}

impl Tile {
    /// All of a picture.
    pub fn whole(size: [u32; 2]) -> Self {
        Self { origin: [0, 0], size }
    }

    /// Returns true if it has pixels, and all of them are in a picture of this size.
    pub fn is_within(&self, picture: [u32; 2]) -> bool {
        (0..2).all(|axis| {
            let [first, length] = [self.origin[axis], self.size[axis]];
            length > 0 && first.checked_add(length).is_some_and(|end| end <= picture[axis])
        })
    }

    /// The smallest tile around it whose sides are multiples of [`STEP`], except at the border of
    /// the picture. Renderers work in blocks of that size.
    fn aligned(&self, picture: [u32; 2]) -> Self {
        let origin = self.origin.map(|first| first / STEP * STEP);
        let end = |axis: usize| {
            let end = self.origin[axis].saturating_add(self.size[axis]);
            end.div_ceil(STEP).saturating_mul(STEP).min(picture[axis])
        };
        Self { origin, size: [0, 1].map(|axis| end(axis).saturating_sub(origin[axis])) }
    }

    /// The number of its pixels.
    pub fn pixels(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }

    /// Rectangles of at most `side` columns and rows that cover the tile.
    pub(crate) fn blocks(&self, side: u32) -> Vec<Self> {
        let starts = |axis: usize| (0..self.size[axis]).step_by(side.max(1) as usize);
        let block = |x: u32, y: u32| Self {
            origin: [self.origin[0] + x, self.origin[1] + y],
            size: [side.min(self.size[0] - x), side.min(self.size[1] - y)],
        };
        starts(1).flat_map(|y| starts(0).map(move |x| block(x, y))).collect()
    }

    /// Column and row in the picture of the tile's pixel at an index, row by row.
    pub(crate) fn position(&self, index: usize) -> [u32; 2] {
        let columns = self.size[0].max(1) as usize;
        let [x, y] = [index % columns, index / columns].map(|offset| offset as u32);
        [self.origin[0] + x, self.origin[1] + y]
    }
}

/// The size of tiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TileSize {
    /// Starts with small tiles and adapts their size to a time per tile.
    Adaptive {
        /// The time that one tile should take.
        milliseconds: f64,
    },
    /// Tiles of this many columns and rows, fewer at the right and lower border.
    Fixed([u32; 2]),
}

impl Default for TileSize {
    /// 60 ms a tile: far from the time after which drivers consider a device lost (about 2 s), and
    /// long enough that starting a tile costs little.
    fn default() -> Self {
        Self::Adaptive { milliseconds: 60.0 }
    }
}

/// Pixels of the first adaptive tile: a third of a second at 5 ms a pixel, as a software adapter
/// takes for thousands of primitives.
const FIRST_PIXELS: u32 = 64;
/// The maximum rows of an adaptive tile if nothing is known of the cost: a band that starts in an
/// empty sky keeps its height where it reaches something costly, but its tiles can still become
/// narrow.
const MAX_ROWS: u32 = 64;
/// Columns and rows are multiples of this, a workgroup's side, except at the border.
const STEP: u32 = 8;
/// The maximum growth in pixels from one tile to the next.
const GROWTH: f64 = 4.0;
/// The maximum shrinkage in pixels from one tile to the next.
const SHRINKAGE: f64 = 16.0;

/// Iterates over the tiles of a region: bands from the top, tiles in a band from the left.
///
/// The tiles consist of the picture's blocks of [`STEP`] by [`STEP`] pixels. So they cover a little
/// more than a region whose sides are no multiples, and a block that a region cuts has the active
/// lists that it has in the whole picture. Wider tiles, which begin with the drawn ones, only sort
/// out iterations that each block in them would sort out: along the narrower cone of a block, no
/// step of the same search is shorter.
#[derive(Clone, Debug)]
pub(crate) struct Tiler {
    region: Tile,
    tile_size: TileSize,
    /// The target number of pixels of an adaptive tile, and its maximum.
    wanted: u32,
    most: u32,
    /// The maximum rows of an adaptive tile.
    max_rows: u32,
    next: [u32; 2],
    band: u32,
}

impl Tiler {
    /// Tiles of a region of a picture with at most `most` pixels each, and as many columns or rows.
    pub(crate) fn new(picture: [u32; 2], region: Tile, tile_size: TileSize, most: u32) -> Self {
        let most = most.max(STEP * STEP);
        let wanted = FIRST_PIXELS.min(most);
        let region = region.aligned(picture);
        Self { region, tile_size, wanted, most, max_rows: MAX_ROWS, next: [0, 0], band: 0 }
    }

    /// The number of pixels of all tiles.
    pub(crate) fn pixels(&self) -> u64 {
        self.region.pixels() as u64
    }

    /// The same tiles, the first of which has this many pixels if they adapt.
    pub(crate) fn starting_with(self, pixels: u32) -> Self {
        Self { wanted: pixels.min(self.most), ..self }
    }

    /// The same tiles, larger from the start if they adapt: a pixel is expected to take this many
    /// milliseconds, as in the last frame. The first tile takes a quarter of the time that a tile
    /// should take, and the narrowest one of a band a sixteenth, in case this frame is slower.
    #[cfg(any(feature = "gpu", test))]
    pub(crate) fn after(self, cost: Option<f64>) -> Self {
        let (TileSize::Adaptive { milliseconds }, Some(cost)) = (self.tile_size, cost) else {
            return self;
        };
        let fitting = milliseconds / cost.max(1e-9);
        let wanted = ((fitting / GROWTH) as u32).clamp(self.wanted, self.most);
        let rows = (fitting / SHRINKAGE) as u32 / STEP;
        Self { wanted, max_rows: rows.max(MAX_ROWS), ..self }
    }

    /// The next tile.
    pub(crate) fn next(&mut self) -> Option<Tile> {
        let [width, height] = self.region.size;
        let [x, y] = self.next;
        if y >= height || width == 0 {
            return None;
        }
        if x == 0 {
            self.band = self.rows().clamp(1, height - y);
        }
        let columns = self.columns().clamp(1, width - x);
        let [left, top] = self.region.origin;
        let tile = Tile { origin: [left + x, top + y], size: [columns, self.band] };
        self.next = if x + columns < width { [x + columns, y] } else { [0, y + self.band] };
        Some(tile)
    }

    fn rows(&self) -> u32 {
        match self.tile_size {
            TileSize::Adaptive { .. } => {
                // As square as the picture allows.
                let width = (self.wanted.isqrt()).min(self.region.size[0]).max(1);
                multiple(self.wanted / width).min(self.max_rows)
            }
            TileSize::Fixed([width, height]) => height.min(self.most / width.clamp(1, self.most)),
        }
    }

    fn columns(&self) -> u32 {
        match self.tile_size {
            TileSize::Adaptive { .. } => multiple(self.wanted / self.band.max(1)),
            TileSize::Fixed([width, _]) => width.min(self.most),
        }
    }

    /// Adapts the tile size to the time of the last tile, in milliseconds.
    pub(crate) fn took(&mut self, tile: Tile, elapsed: f64) {
        if let TileSize::Adaptive { milliseconds } = self.tile_size {
            let pixels = tile.pixels() as f64;
            let fitting = pixels * milliseconds / elapsed.max(1e-6);
            // Neighbouring tiles may differ much in cost: sky beside a grazing surface.
            let fitting = fitting.clamp(pixels / SHRINKAGE, pixels * GROWTH);
            self.wanted = (fitting as u32).clamp(STEP * STEP, self.most);
        }
    }
}

/// The next lower multiple of a workgroup's side, but not 0.
fn multiple(length: u32) -> u32 {
    (length / STEP * STEP).max(STEP)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that the tiles cover the picture once, if each takes the given time; returns them.
    fn cover(
        picture: [u32; 2],
        size: TileSize,
        most: u32,
        time: impl Fn(usize) -> f64,
    ) -> Vec<Tile> {
        let mut tiler = Tiler::new(picture, Tile::whole(picture), size, most);
        let mut seen = vec![0u8; picture[0] as usize * picture[1] as usize];
        let mut tiles = Vec::new();
        while let Some(tile) = tiler.next() {
            assert!(tile.pixels() <= most as usize, "{tile:?}");
            for y in tile.origin[1]..tile.origin[1] + tile.size[1] {
                for x in tile.origin[0]..tile.origin[0] + tile.size[0] {
                    seen[(y * picture[0] + x) as usize] += 1;
                }
            }
            tiler.took(tile, time(tile.pixels()));
            tiles.push(tile);
        }
        assert!(seen.iter().all(|count| *count == 1), "{picture:?} {size:?}");
        tiles
    }

    #[test]
    fn tiles_cover_every_pixel_once() {
        for picture in [[1, 1], [4097, 3], [3, 4097], [640, 360], [65, 67]] {
            for size in [TileSize::default(), TileSize::Fixed([7, 5]), TileSize::Fixed([5000, 1])] {
                cover(picture, size, 1 << 16, |pixels| pixels as f64 * 0.01);
            }
        }
    }

    #[test]
    fn tiles_grow_on_a_fast_adapter_and_shrink_on_a_slow_one() {
        let fast = cover([1920, 1080], TileSize::default(), 1 << 20, |pixels| pixels as f64 * 1e-6);
        assert!(fast.len() < 60, "{} tiles", fast.len());
        let slow = cover([256, 256], TileSize::default(), 1 << 20, |pixels| pixels as f64 * 0.5);
        assert!(slow.iter().all(|tile| tile.pixels() <= 128));
    }

    #[test]
    fn a_frame_begins_with_the_tiles_that_the_last_one_allows() {
        let tiles = |picture, cost: f64| {
            let mut tiler = Tiler::new(picture, Tile::whole(picture), TileSize::default(), 1 << 21);
            tiler = tiler.after(Some(cost));
            std::iter::from_fn(|| {
                let tile = tiler.next()?;
                tiler.took(tile, cost * tile.pixels() as f64);
                Some(tile)
            })
            .collect::<Vec<_>>()
        };
        let whole = |picture| vec![Tile::whole(picture)];
        assert_eq!(tiles([1920, 1080], 1e-6), whole([1920, 1080]));
        // 60 ms are 6,000 pixels, and the first tile has a quarter of them.
        let slow = tiles([1920, 1080], 1e-2);
        assert_eq!(slow[0].size, [40, 32]);
        assert!(slow.iter().all(|tile| tile.size[1] <= MAX_ROWS && tile.pixels() <= 6000));
    }

    #[test]
    fn tiles_become_narrow_where_a_band_meets_something_costly() {
        let picture = [16_384, 4096];
        let mut tiler = Tiler::new(picture, Tile::whole(picture), TileSize::default(), 1 << 16);
        // Cheap until a tile has as many rows and columns as it may.
        let wide = loop {
            let tile = tiler.next().unwrap();
            tiler.took(tile, 1e-3);
            if tile.size[0] == 1024 {
                break tile;
            }
        };
        let met = tiler.next().unwrap();
        assert_eq!((met.origin[1], met.size), (wide.origin[1], wide.size));
        tiler.took(met, 1e5);
        assert_eq!(tiler.next().unwrap().size, [1024 / 16, MAX_ROWS]);
    }

    #[test]
    fn tiles_cover_a_region_in_blocks_of_the_picture() {
        let region = Tile { origin: [13, 7], size: [30, 90] };
        for size in [TileSize::default(), TileSize::Fixed([16, 24])] {
            let mut tiler = Tiler::new([100, 99], region, size, 1 << 16);
            let (mut covered, mut tiles) = (tiler.pixels(), Vec::new());
            while let Some(tile) = tiler.next() {
                assert_eq!(tile.origin.map(|first| first % STEP), [0, 0]);
                assert!(tile.is_within([100, 99]), "{tile:?}");
                covered -= tile.pixels() as u64;
                tiler.took(tile, 1.0);
                tiles.push(tile);
            }
            assert_eq!(covered, 0);
            assert_eq!(tiles.first().map(|tile| tile.origin), Some([8, 0]));
            let last = tiles.last().map(|tile| [0, 1].map(|a| tile.origin[a] + tile.size[a]));
            assert_eq!(last, Some([48, 99]), "beyond the region, but not beyond the picture");
        }
        let far = Tile { origin: [u32::MAX, 0], size: [2, 1] };
        assert!(!far.is_within([100, 99]));
    }

    #[test]
    fn no_tile_passes_the_limit() {
        cover([100, 100], TileSize::Fixed([100, 100]), 300, |_| 1.0);
        cover([1000, 1000], TileSize::default(), 300, |_| 1e-9);
    }
}
