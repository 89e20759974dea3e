//! An SPI bus with a select pin that is high for the device: what `embedded-hal-bus` offers for pins that are low.

use core::fmt::Debug;
use embedded_hal::digital::OutputPin;
use embedded_hal::spi::{Error, ErrorKind, ErrorType, Operation, SpiBus, SpiDevice};

/// The only user of the bus, selected by a high pin during its transactions.
///
/// `embedded-hal` asks devices for delays, too; this one has no clock to wait by and ignores them.
pub(crate) struct Selected<B, P> {
    bus: B,
    select: P,
}

/// What went wrong in a transaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fault<B, P> {
    /// The bus.
    Bus(B),
    /// The select pin.
    Select(P),
}

impl<B: Error, P: Debug> Error for Fault<B, P> {
    fn kind(&self) -> ErrorKind {
        match self {
            Self::Bus(error) => error.kind(),
            Self::Select(_) => ErrorKind::ChipSelectFault,
        }
    }
}

impl<B: SpiBus, P: OutputPin> Selected<B, P> {
    /// The device, not selected.
    pub(crate) fn new(bus: B, mut select: P) -> Result<Self, P::Error> {
        select.set_low()?;
        Ok(Self { bus, select })
    }
}

impl<B: SpiBus, P: OutputPin> ErrorType for Selected<B, P> {
    type Error = Fault<B::Error, P::Error>;
}

impl<B: SpiBus, P: OutputPin> SpiDevice for Selected<B, P> {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Self::Error> {
        self.select.set_high().map_err(Fault::Select)?;
        let done = operations.iter_mut().try_for_each(|operation| match operation {
            Operation::Read(bytes) => self.bus.read(bytes),
            Operation::Write(bytes) => self.bus.write(bytes),
            Operation::Transfer(read, write) => self.bus.transfer(read, write),
            Operation::TransferInPlace(bytes) => self.bus.transfer_in_place(bytes),
            Operation::DelayNs(_) => Ok(()),
        });
        // Whatever happened, the device is left alone.
        let done = done.and(self.bus.flush());
        let left = self.select.set_low();
        done.map_err(Fault::Bus).and(left.map_err(Fault::Select))
    }
}
