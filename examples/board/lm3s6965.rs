//! What the LM3S6965 evaluation board needs for its OLED and its serial line: SPI (a PL022), pins (PL061), UART (a
//! PL011), by their registers.
//!
//! Run under QEMU only, which looks at neither clock gates nor pin functions nor the panel's supply: for those this
//! follows the published pin table of the board. The 8 MHz crystal drives all, SPI runs at 4 MHz, the serial line at
//! 115 200 baud. For a board of your own, put the types of its HAL in the place of this file.

use core::convert::Infallible;
use core::fmt;
use embedded_hal::digital::{self, OutputPin};
use embedded_hal::spi::{self, SpiBus};

// System control: the clocks of the chip, of peripherals, of ports.
const RCC: usize = 0x400f_e060;
const RCGC1: usize = 0x400f_e104;
const RCGC2: usize = 0x400f_e108;

const PORT_A: usize = 0x4000_4000;
const PORT_C: usize = 0x4000_6000;
const PORT_D: usize = 0x4000_7000;
// Offsets of a port: direction, alternate function, digital enable.
const DIR: usize = 0x400;
const AFSEL: usize = 0x420;
const DEN: usize = 0x51c;

const SSI0: usize = 0x4000_8000;
const UART0: usize = 0x4000_c000;

fn read(register: usize) -> u32 {
    // SAFETY: a register of this chip, one of the constants of this file and their offsets.
    unsafe { (register as *const u32).read_volatile() }
}

fn write(register: usize, value: u32) {
    // SAFETY: as above; none of the registers written lets the hardware touch memory.
    unsafe { (register as *mut u32).write_volatile(value) }
}

fn set(register: usize, bits: u32) {
    write(register, read(register) | bits);
}

/// The parts of the board that the example uses.
pub(crate) struct Board {
    /// The bus of the OLED and the card slot.
    pub(crate) spi: Spi,
    /// PD0, which selects the card where it is low. QEMU takes it, high, for the OLED's select; on the board that is
    /// PA3, which the bus drives.
    pub(crate) select: Pin,
    /// PC7: low for commands to the OLED, high for its pixels.
    pub(crate) data: Pin,
    /// The serial line.
    pub(crate) serial: Serial,
}

impl Board {
    /// Switches on what is used. Call it once.
    pub(crate) fn start() -> Self {
        // The main oscillator with its crystal of 8 MHz, undivided; no PLL.
        write(RCC, 1 << 13 | 1 << 11 | 0xe << 6);
        set(RCGC1, 1 << 4 | 1); // SSI0, UART0
        set(RCGC2, 1 << 3 | 1 << 2 | 1); // ports D, C, A
        read(RCGC2); // a port answers some cycles after its clock is on

        // Port A: receive, transmit, SPI clock, frame and data out.
        let pins = 1 | 1 << 1 | 1 << 2 | 1 << 3 | 1 << 5;
        set(PORT_A + AFSEL, pins);
        set(PORT_A + DEN, pins);
        let mut supply = Pin::output(PORT_C, 6); // of the OLED, 15 V
        let Ok(()) = supply.set_high();
        Self {
            spi: Spi::start(),
            select: Pin::output(PORT_D, 0),
            data: Pin::output(PORT_C, 7),
            serial: Serial::start(),
        }
    }
}

/// An output pin.
pub(crate) struct Pin {
    /// The data register whose address masks all other pins.
    register: usize,
    high: u32,
}

impl Pin {
    fn output(port: usize, number: u32) -> Self {
        let high = 1 << number;
        set(port + DIR, high);
        set(port + DEN, high);
        Self { register: port + ((high as usize) << 2), high }
    }
}

impl digital::ErrorType for Pin {
    type Error = Infallible;
}

impl OutputPin for Pin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        write(self.register, 0);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        write(self.register, self.high);
        Ok(())
    }
}

/// The SPI bus: mode 0, 8 bits.
pub(crate) struct Spi;

impl Spi {
    // Offsets: control, data, status, prescaler.
    const CR0: usize = SSI0;
    const CR1: usize = SSI0 + 0x4;
    const DR: usize = SSI0 + 0x8;
    const SR: usize = SSI0 + 0xc;
    const CPSR: usize = SSI0 + 0x10;
    // Status bits.
    const NOT_FULL: u32 = 1 << 1;
    const NOT_EMPTY: u32 = 1 << 2;
    const BUSY: u32 = 1 << 4;

    fn start() -> Self {
        write(Self::CR1, 0);
        write(Self::CPSR, 2);
        write(Self::CR0, 7); // 8 bits
        write(Self::CR1, 1 << 1);
        Self
    }

    fn status(bit: u32) -> bool {
        read(Self::SR) & bit != 0
    }

    fn send(byte: u8) {
        while !Self::status(Self::NOT_FULL) {}
        write(Self::DR, byte.into());
    }

    /// Throws away what came back.
    fn drain() {
        while Self::status(Self::NOT_EMPTY) {
            read(Self::DR);
        }
    }

    fn exchange(byte: u8) -> u8 {
        Self::send(byte);
        while !Self::status(Self::NOT_EMPTY) {}
        read(Self::DR) as u8
    }
}

impl spi::ErrorType for Spi {
    type Error = Infallible;
}

impl SpiBus for Spi {
    fn read(&mut self, words: &mut [u8]) -> Result<(), Infallible> {
        words.iter_mut().for_each(|word| *word = Self::exchange(0));
        Ok(())
    }

    fn write(&mut self, words: &[u8]) -> Result<(), Infallible> {
        for word in words {
            Self::send(*word);
            Self::drain();
        }
        self.flush()
    }

    fn transfer(&mut self, read: &mut [u8], write: &[u8]) -> Result<(), Infallible> {
        let mut words = write.iter();
        read.iter_mut().for_each(|word| *word = Self::exchange(words.next().copied().unwrap_or(0)));
        self.write(words.as_slice())
    }

    fn transfer_in_place(&mut self, words: &mut [u8]) -> Result<(), Infallible> {
        words.iter_mut().for_each(|word| *word = Self::exchange(*word));
        Ok(())
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        while Self::status(Self::BUSY) {}
        Self::drain();
        Ok(())
    }
}

/// The serial line.
pub(crate) struct Serial;

impl Serial {
    const DR: usize = UART0;
    const FR: usize = UART0 + 0x18;
    const NOTHING_RECEIVED: u32 = 1 << 4;
    const FULL: u32 = 1 << 5;

    fn start() -> Self {
        write(UART0 + 0x30, 0);
        // 8 MHz / (16 · 115 200) = 4 + 22/64.
        write(UART0 + 0x24, 4);
        write(UART0 + 0x28, 22);
        write(UART0 + 0x2c, 3 << 5); // 8 bits
        write(UART0 + 0x30, 1 << 9 | 1 << 8 | 1); // receive, transmit
        Self
    }

    /// The byte that was received, if any.
    pub(crate) fn received(&mut self) -> Option<u8> {
        (read(Self::FR) & Self::NOTHING_RECEIVED == 0).then(|| read(Self::DR) as u8)
    }
}

impl fmt::Write for Serial {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for byte in text.bytes() {
            while read(Self::FR) & Self::FULL != 0 {}
            write(Self::DR, byte.into());
        }
        Ok(())
    }
}
