//! The board's display: `examples/fw_oled.rs` runs on QEMU's LM3S6965 kit, and the panel's pixels at three angles of
//! one run, after more than a full turn, are the host's picture of the same frame through the same public calls.
//!
//! On the host: the panel's driver against a recorded SPI device, and the picture within the screen at every angle.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "common/firmware.rs"]
mod firmware;
#[path = "common/machine.rs"]
mod machine;
#[path = "../examples/board/selected.rs"]
mod selected;
#[path = "../examples/board/ssd0323.rs"]
mod ssd0323;
#[path = "../examples/data/teapot.rs"]
#[allow(dead_code, reason = "its parts for fitting")]
mod teapot;
#[path = "../examples/data/turning.rs"]
mod turning;

use embedded_graphics::Pixel;
use embedded_graphics::pixelcolor::{Gray4, GrayColor};
use embedded_graphics::prelude::{DrawTarget, Point, Size};
use embedded_graphics::primitives::Rectangle;
use embedded_graphics_simulator::SimulatorDisplay;
use embedded_surfaces::render::{Light, Scene, Style};
use machine::Machine;
use std::cell::RefCell;
use std::convert::Infallible;
use turning::{AREA, Buffers, TURN, draw};

const TARGET: &str = "thumbv7m-none-eabi";
/// What the machine has, and what the example may take of its RAM, stack included.
const FLASH: u64 = 256 << 10;
const RAM: usize = 64 << 10;
const RAM_BUDGET: usize = 32 << 10;
/// The frames to halt at: 27°, 153° and 270° after a full turn.
const FRAMES: [u32; 3] = [TURN + 3, TURN + 17, TURN + 30];

#[test]
fn the_panel_shows_what_the_host_draws() {
    if firmware::installed(&[TARGET]).is_empty() {
        return;
    }
    let image =
        firmware::cargo("build", TARGET, &["--example", "fw_oled"], &[firmware::FOR_SIZE]).join("examples/fw_oled");
    let elf = std::fs::read(&image).unwrap();
    let (flash, statics) = firmware::sizes(&elf);
    assert!(flash <= FLASH, "{flash} bytes of flash");
    let bad = |name: &String| firmware::offence(name).is_some_and(|why| why != "a panic");
    assert!(!firmware::symbols(&elf).iter().any(bad), "soft float or an allocator");
    if firmware::installed_runner(TARGET).is_none() {
        return;
    }
    let mut board = Machine::start("lm3s6965evb", &image);
    for frame in FRAMES {
        board.send(&[frame as u8]);
        // Late bytes halt it at a later frame, which is as good.
        let line = board.line();
        let shown: u32 = line.strip_prefix("READY ").and_then(|n| n.parse().ok()).unwrap_or_else(|| panic!("{line}"));
        assert!(shown >= frame, "{shown}");
        let dump = board.screen();
        assert_eq!((dump.width, dump.height), (4 * AREA.width, 4 * AREA.height));
        compare(&dump, &picture(shown), shown);
    }
    let used = used(&board.memory(0x2000_0000, RAM));
    eprintln!("fw_oled: {flash} bytes of flash, {used} of RAM, {statics} of them static");
    assert!(used <= RAM_BUDGET, "{used} bytes of RAM");
}

/// Each pixel is 4 × 4 of the dump, grey g of 0 ..= 15 as (17·g, 17·g, 17·g).
fn compare(dump: &machine::Picture, expected: &SimulatorDisplay<Gray4>, frame: u32) {
    let mut levels = [false; 16];
    for y in 0..dump.height {
        for x in 0..dump.width {
            let grey = expected.get_pixel(Point::new(x as i32 / 4, y as i32 / 4)).luma();
            levels[usize::from(grey)] = true;
            assert_eq!(dump.pixel(x, y), [17 * grey; 3], "frame {frame}, ({x}, {y}) of the dump");
        }
    }
    assert!(levels.iter().filter(|used| **used).count() > 8, "frame {frame}: hardly any shades, {levels:?}");
}

/// The host's picture of a frame.
fn picture(frame: u32) -> SimulatorDisplay<Gray4> {
    let mut display = SimulatorDisplay::new(Size::new(AREA.width, AREA.height));
    let statistics = draw(frame, &mut Buffers::new(), &mut display).unwrap();
    assert!(statistics.points > 1000);
    display
}

/// Bytes of RAM in use at most: all without the longest run of zero words, which nothing has written since the start.
fn used(memory: &[u8]) -> usize {
    let words: Vec<_> = memory.chunks_exact(4).map(|word| word == [0; 4]).collect();
    let free = words.chunk_by(|a, b| a == b).filter(|run| run[0]).map(<[bool]>::len).max().unwrap_or(0);
    memory.len() - 4 * free
}

#[test]
fn nothing_is_cut_off_at_any_angle() {
    for frame in 0..TURN {
        let patches = teapot::patches(&turning::map(frame).unwrap()).unwrap();
        let pixels = Scene::new(&patches, Light::default(), Style::Flat).unwrap().area().unwrap();
        assert!(pixels.x >= 0 && pixels.y >= 0, "frame {frame}: {pixels:?}");
        assert!(pixels.x + pixels.width as i32 <= AREA.width as i32, "frame {frame}: {pixels:?}");
        assert!(pixels.y + pixels.height as i32 <= AREA.height as i32, "frame {frame}: {pixels:?}");
    }
    assert!(picture(1) == picture(TURN + 1), "a turn is not a turn");
}

// The driver.

/// What goes over the wires: pins and bytes in one log.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Event {
    Select(bool),
    Data(bool),
    Bytes(Vec<u8>),
}

struct Bus<'l>(&'l RefCell<Vec<Event>>);
struct Pin<'l>(&'l RefCell<Vec<Event>>, fn(bool) -> Event);

impl embedded_hal::spi::ErrorType for Bus<'_> {
    type Error = Infallible;
}

impl embedded_hal::spi::SpiBus for Bus<'_> {
    fn read(&mut self, _: &mut [u8]) -> Result<(), Infallible> {
        unreachable!("the panel is never read")
    }

    fn write(&mut self, words: &[u8]) -> Result<(), Infallible> {
        self.0.borrow_mut().push(Event::Bytes(words.to_vec()));
        Ok(())
    }

    fn transfer(&mut self, _: &mut [u8], _: &[u8]) -> Result<(), Infallible> {
        unreachable!("the panel is never read")
    }

    fn transfer_in_place(&mut self, _: &mut [u8]) -> Result<(), Infallible> {
        unreachable!("the panel is never read")
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

impl embedded_hal::digital::ErrorType for Pin<'_> {
    type Error = Infallible;
}

impl embedded_hal::digital::OutputPin for Pin<'_> {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.borrow_mut().push(self.1(false));
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.borrow_mut().push(self.1(true));
        Ok(())
    }
}

/// A panel that obeys the log: selected, commands with the pin low, pixels with it high.
fn panel(log: &[Event]) -> Vec<u8> {
    let (mut selected, mut data, mut window, mut memory) = (false, false, [0, 0, 0, 0], vec![0xee; 64 * 64]);
    for event in log {
        match event {
            Event::Select(high) => selected = *high,
            Event::Data(high) => data = *high,
            Event::Bytes(bytes) => {
                assert!(selected, "{event:?} goes to the card");
                match (data, bytes.as_slice()) {
                    (false, [0x15, first, last]) => [window[0], window[1]] = [*first, *last],
                    (false, [0x75, first, last]) => [window[2], window[3]] = [*first, *last],
                    (false, command) => assert!([0x81, 0xa0, 0xa4, 0xaf].contains(&command[0]), "{:x}", command[0]),
                    (true, pixels) => {
                        let [left, right, top, bottom] = window.map(usize::from);
                        assert_eq!(pixels.len(), (right + 1 - left) * (bottom + 1 - top));
                        for (k, byte) in pixels.iter().enumerate() {
                            let width = right + 1 - left;
                            memory[(top + k / width) * 64 + left + k % width] = *byte;
                        }
                    }
                }
            }
        }
    }
    assert!(!selected);
    memory
}

#[test]
fn the_driver_sends_what_is_drawn() {
    let log = RefCell::new(Vec::new());
    let device = selected::Selected::new(Bus(&log), Pin(&log, Event::Select)).unwrap();
    let mut display = ssd0323::Ssd0323::new(device, Pin(&log, Event::Data));
    display.start().unwrap();
    assert_eq!(panel(&log.borrow()), [0; 64 * 64]);

    draw(5, &mut Buffers::new(), &mut display).unwrap();
    let expected = picture(5);
    let memory = panel(&log.borrow());
    for (k, byte) in memory.iter().enumerate() {
        let grey = |x: usize| expected.get_pixel(Point::new(x as i32, k as i32 / 64)).luma();
        assert_eq!(*byte, grey(2 * (k % 64)) << 4 | grey(2 * (k % 64) + 1), "byte {k}");
    }
}

#[test]
fn the_driver_keeps_the_other_half_of_a_byte_and_clips() {
    let log = RefCell::new(Vec::new());
    let device = selected::Selected::new(Bus(&log), Pin(&log, Event::Select)).unwrap();
    let mut display = ssd0323::Ssd0323::new(device, Pin(&log, Event::Data));
    display.start().unwrap();
    let pixel = |x, y, grey| Pixel(Point::new(x, y), Gray4::new(grey));
    display.draw_iter([pixel(2, 3, 7), pixel(3, 3, 9), pixel(127, 63, 1)]).unwrap();
    display.draw_iter([pixel(3, 3, 2)]).unwrap();
    let sent = log.borrow().len();
    display.draw_iter([pixel(-1, 3, 5), pixel(128, 3, 5), pixel(0, 64, 5), pixel(0, i32::MIN, 5)]).unwrap();
    assert_eq!(log.borrow().len(), sent, "nothing to send");
    display.fill_solid(&Rectangle::new(Point::new(125, -2), Size::new(9, 3)), Gray4::new(4)).unwrap();
    let mut expected = vec![0; 64 * 64];
    expected[3 * 64 + 1] = 0x72;
    expected[63 * 64 + 63] = 0x01;
    [expected[62], expected[63]] = [0x04, 0x44];
    assert_eq!(panel(&log.borrow()), expected);
}
