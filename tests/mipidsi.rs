//! `examples/mipidsi.rs`: a panel that obeys the recorded commands shows the picture that is drawn at once, each band
//! is one write, and firmware sends what the host sends.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../examples/mipidsi.rs"]
#[allow(dead_code, reason = "its `main` is for `cargo run`")]
mod example;
#[path = "common/firmware.rs"]
mod firmware;

use embedded_graphics_core::pixelcolor::raw::ToBytes;
use embedded_surfaces::render::{Frame, Light, Scene, Style};
use example::{BACKGROUND, PAINT, ROWS, SCREEN, Sent};

/// A controller's memory of 320 × 240 pixels of two bytes, written as the commands say.
struct Panel {
    memory: Vec<[u8; 2]>,
    /// First and last column, first and last row.
    window: [u16; 4],
    /// Pixels written since the last command to write.
    written: usize,
    /// The window of each command to write.
    writes: Vec<[u16; 4]>,
}

impl Panel {
    fn obey(&mut self, sent: Sent<'_>) {
        let pair = |a: &[u8]| [u16::from_be_bytes([a[0], a[1]]), u16::from_be_bytes([a[2], a[3]])];
        match sent {
            Sent::Command(0x2a, columns) => [self.window[0], self.window[1]] = pair(columns),
            Sent::Command(0x2b, rows) => [self.window[2], self.window[3]] = pair(rows),
            Sent::Command(0x2c, arguments) => {
                assert!(arguments.is_empty());
                self.writes.push(self.window);
                self.written = 0;
            }
            Sent::Command(..) => assert_eq!(self.writes, [[0; 4]; 0], "only windows and writes after the start"),
            Sent::Pixels(bytes) => {
                let [left, right, top, bottom] = self.window.map(usize::from);
                let width = right + 1 - left;
                let (x, y) = (left + self.written % width, top + self.written / width);
                assert!(y <= bottom, "more pixels than the window holds");
                self.memory[y * SCREEN.width as usize + x] = bytes.try_into().unwrap();
                self.written += 1;
            }
        }
    }
}

#[test]
fn the_recorded_bytes_are_the_picture() {
    let pixels = SCREEN.pixels();
    let mut panel = Panel { memory: vec![[0xee; 2]; pixels], window: [0; 4], written: 0, writes: Vec::new() };
    let bands = example::run(|sent| panel.obey(sent)).unwrap();

    let patches = example::patches().unwrap();
    let scene = Scene::new(&patches, Light::default(), Style::Shaded).unwrap();
    let mut whole = Frame::new(scene, &PAINT, BACKGROUND, SCREEN, SCREEN.height).unwrap();
    let (mut colour, mut depth) = (vec![BACKGROUND; pixels], vec![0; pixels]);
    let picture = whole.next_band(&mut colour, &mut depth).unwrap().unwrap();
    let expected: Vec<_> = picture.pixels().iter().map(|colour| colour.to_be_bytes()).collect();
    assert!(expected.iter().filter(|bytes| **bytes != BACKGROUND.to_be_bytes()).count() > pixels / 4);
    for (k, (shown, drawn)) in panel.memory.iter().zip(&expected).enumerate() {
        assert_eq!(shown, drawn, "({}, {})", k % SCREEN.width as usize, k / SCREEN.width as usize);
    }

    let windows = (0..SCREEN.height / ROWS).map(|k| [0, SCREEN.width - 1, k * ROWS, (k + 1) * ROWS - 1]);
    let windows: Vec<_> = windows.map(|window| window.map(|c| c as u16)).collect();
    assert_eq!(panel.writes, windows, "one write a band, from the top");
    assert_eq!(bands as usize, windows.len());
}

#[test]
fn thumbv7em_sends_the_same() {
    firmware_sends_the_same("thumbv7em-none-eabihf");
}

#[test]
fn riscv32imc_sends_the_same() {
    firmware_sends_the_same("riscv32imc-unknown-none-elf");
}

fn firmware_sends_the_same(target: &str) {
    let Some(runner) = firmware::board(target) else { return };
    let image =
        firmware::cargo("build", target, &["--example", "mipidsi"], &[firmware::FOR_SIZE]).join("examples/mipidsi");
    let mut expected = String::new();
    example::report(&mut expected).unwrap();
    assert_eq!(firmware::run(&runner, &image), expected);
}
