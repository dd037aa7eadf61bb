//! Few colours in place of many.

/// How many bits of each channel tell colours apart when they are counted.
const BITS: u32 = 7;

/// How many colours may be asked for.
pub(super) const MOST: usize = 255;

/// How many answers are remembered.
const REMEMBERED: usize = 1 << 14;

pub(super) type Color = [u8; 3];

/// A choice of colours, and a quick way to the nearest one.
#[derive(Debug)]
pub(super) struct Palette {
    colors: Vec<Color>,
    /// The same, one array for each channel, filled up with what is far from any colour.
    channels: [[f32; MOST + 1]; 3],
    /// How far apart neighbours are, in the mean.
    step: f32,
    /// Colours asked for before, and the answers.
    remembered: Vec<(Color, u8)>,
}

/// Pixels of about the same colour.
#[derive(Clone, Copy, Debug, Default)]
struct Heap {
    count: f32,
    sum: [f32; 3],
}

impl Heap {
    fn mean(&self) -> [f32; 3] {
        self.sum.map(|sum| sum / self.count.max(1.0))
    }
}

impl Palette {
    /// Chooses at most [`MOST`] colours that do justice to some pixels.
    pub(super) fn new(pixels: impl Iterator<Item = Color>) -> Self {
        let mut heaps = heaps(pixels);
        let groups = groups(&mut heaps);
        let colors: Vec<Color> = groups.iter().map(|group| group.mean.map(|channel| (channel + 0.5) as u8)).collect();
        let channels = [0, 1, 2]
            .map(|at| std::array::from_fn(|index| colors.get(index).map_or(1e6, |color: &Color| f32::from(color[at]))));
        let mut palette = Self { step: step(&colors), colors, channels, remembered: Vec::new() };
        let black = ([0; 3], palette.search([0; 3]));
        palette.remembered = vec![black; REMEMBERED];
        palette
    }

    /// The colours.
    pub(super) fn colors(&self) -> &[Color] {
        &self.colors
    }

    /// How strongly a colour has to be dithered: not at all if it is in the palette, and by as
    /// much as colours in the palette are apart if it is between them.
    pub(super) fn roughness(&mut self, color: Color) -> f32 {
        let nearest = usize::from(self.nearest(color));
        let off = self.colors.get(nearest).map_or(0, |&other| distance(color, other));
        (4.0 * per_channel(off)).min(self.step)
    }

    /// The index of the colour nearest to some colour.
    pub(super) fn nearest(&mut self, color: Color) -> u8 {
        let number = u32::from_le_bytes([color[0], color[1], color[2], 0]);
        let slot = (number.wrapping_mul(0x9e37_79b1) >> (32 - REMEMBERED.ilog2())) as usize;
        if self.remembered[slot].0 != color {
            self.remembered[slot] = (color, self.search(color));
        }
        self.remembered[slot].1
    }

    /// The distances from a colour to all of the palette; those of indices beyond it are immense.
    pub(super) fn distances(&self, color: Color) -> [f32; MOST + 1] {
        let [red, green, blue] = color.map(f32::from);
        let [reds, greens, blues] = &self.channels;
        std::array::from_fn(|at| {
            let (red, green, blue) = (reds[at] - red, greens[at] - green, blues[at] - blue);
            3.0 * red * red + 5.0 * green * green + 2.0 * blue * blue
        })
    }

    fn search(&self, color: Color) -> u8 {
        let distances = self.distances(color);
        let least = distances.iter().fold(f32::INFINITY, |a, &b| if b < a { b } else { a });
        // The palette has no more colours than a byte has values.
        distances.iter().position(|&distance| distance == least).map_or(0, |at| at as u8)
    }
}

/// How different two colours look, roughly: the eye is keenest on green, and dullest on blue. Ten
/// times the square of a difference that is the same in each channel.
pub(super) fn distance(a: Color, b: Color) -> i32 {
    let [red, green, blue] = [0, 1, 2].map(|at| i32::from(a[at]) - i32::from(b[at]));
    3 * red * red + 5 * green * green + 2 * blue * blue
}

/// A distance as the difference it makes in each channel.
fn per_channel(distance: i32) -> f32 {
    (distance as f32 / 10.0).sqrt()
}

/// The mean distance from a colour to the nearest other one, in one channel.
fn step(colors: &[Color]) -> f32 {
    let nearest = colors
        .iter()
        .filter_map(|color| colors.iter().map(|other| distance(*color, *other)).filter(|&distance| distance > 0).min());
    let sum: f32 = nearest.map(per_channel).sum();
    sum / colors.len().max(1) as f32
}

/// Sorts pixels into heaps.
fn heaps(pixels: impl Iterator<Item = Color>) -> Vec<Heap> {
    // Places are counted from one; zero is none, and costs no memory until it is touched.
    let mut places = vec![0u32; 1 << (3 * BITS)];
    let mut heaps: Vec<Heap> = Vec::new();
    for color in pixels {
        let key = color.iter().fold(0, |key, &channel| key << BITS | shade(channel));
        if places[key] == 0 {
            heaps.push(Heap::default());
            places[key] = heaps.len() as u32;
        }
        let heap = &mut heaps[places[key] as usize - 1];
        heap.count += 1.0;
        heap.sum = [0, 1, 2].map(|at| heap.sum[at] + f32::from(color[at]));
    }
    heaps
}

/// The number that tells a channel from others: everything in the dark, where faint gradients show every
/// step, and every fourth value in the light.
fn shade(channel: u8) -> usize {
    const DARK: usize = 64;
    let channel = usize::from(channel);
    if channel < DARK { channel } else { DARK + (channel - DARK) / 4 }
}

/// Heaps that share one colour of the palette.
struct Group<'a> {
    heaps: &'a mut [Heap],
    mean: [f32; 3],
    /// The channel in which they differ most.
    channel: usize,
    /// How badly one colour does for all of them.
    need: f32,
}

impl<'a> Group<'a> {
    fn new(heaps: &'a mut [Heap]) -> Self {
        let mut all = Heap::default();
        for heap in &*heaps {
            all.count += heap.count;
            all.sum = [0, 1, 2].map(|at| all.sum[at] + heap.sum[at]);
        }
        let mean = all.mean();
        let spread = [0, 1, 2].map(|at| {
            let off = |heap: &Heap| heap.mean()[at] - mean[at];
            heaps.iter().map(|heap| heap.count * off(heap) * off(heap)).sum::<f32>()
        });
        let (mut channel, mut need) = (0, 0.0);
        for (at, spread) in spread.into_iter().enumerate() {
            if spread > need {
                (channel, need) = (at, spread);
            }
        }
        Self { heaps, mean, channel, need }
    }

    /// Parts what is below the mean from what is above.
    fn split(self) -> (Self, Self) {
        let mut low = 0;
        for at in 0..self.heaps.len() {
            if self.heaps[at].mean()[self.channel] < self.mean[self.channel] {
                self.heaps.swap(low, at);
                low += 1;
            }
        }
        let (low, high) = self.heaps.split_at_mut(low);
        (Self::new(low), Self::new(high))
    }
}

/// Divides heaps into groups, each time the group that is most in need of it.
fn groups(heaps: &mut [Heap]) -> Vec<Group<'_>> {
    let mut groups = vec![Group::new(heaps)];
    while groups.len() < MOST {
        let by_need = |&a: &usize, &b: &usize| groups[a].need.total_cmp(&groups[b].need);
        let neediest = (0..groups.len()).max_by(by_need).filter(|&at| groups[at].need > 0.0);
        let Some(neediest) = neediest else { break };
        let (low, high) = groups.swap_remove(neediest).split();
        groups.extend([low, high]);
    }
    // Rounding may have left a group with nothing in it.
    groups.retain(|group| !group.heaps.is_empty());
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_colors_are_kept_exactly() {
        let colors = [[0, 0, 0], [255, 255, 255], [250, 20, 40], [3, 200, 7]];
        let mut palette = Palette::new(colors.into_iter().cycle().take(1000));
        for color in colors.into_iter().chain(colors) {
            let index = palette.nearest(color);
            assert_eq!(palette.colors()[usize::from(index)], color);
        }
    }

    #[test]
    fn many_colors_are_met_closely() {
        let ramp = (0..40_000u32).map(|at| [(at % 200) as u8, (at / 200) as u8, 90]);
        let mut palette = Palette::new(ramp.clone());
        assert_eq!(palette.colors().len(), MOST);
        for color in ramp {
            let index = palette.nearest(color);
            assert!(distance(palette.colors()[usize::from(index)], color) < 10 * 15 * 15);
        }
    }

    #[test]
    fn no_pixels_need_no_colors() {
        let mut palette = Palette::new(std::iter::empty());
        assert_eq!((palette.colors().len(), palette.nearest([1, 2, 3])), (0, 0));
    }
}
